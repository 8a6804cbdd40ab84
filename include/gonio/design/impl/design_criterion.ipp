#pragma once
/// Bodies of design/design_criterion.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/design/design_criterion.hpp>
#include <gonio/solve/dense.hpp>
#include <gonio/solve/singular_values.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace gonio::design {

GONIO_INLINE double condition_number::operator()(const Eigen::MatrixXd& components) const {
  if (components.rows() == 1) return 1.0 / components.norm();
  const Eigen::VectorXd values = singular_values(components, "measurements' components");
  const double smallest = values[0], largest = values[values.size() - 1];
  const double rounding = largest * singular_value_rounding(values.size());
  return smallest > rounding ? largest / smallest : std::numeric_limits<double>::infinity();
}

}  // namespace gonio::design

namespace gonio::design::detail {

/// Returns the Cholesky factor of I + R R' / eta, where R are the components' values at the measurements.
[[nodiscard]] GONIO_INLINE cholesky certainty(const Eigen::MatrixXd& components, double eta) {
  Eigen::MatrixXd gram = product_with_transpose(components);
  gram /= eta;
  for (Eigen::Index i = 0; i < gram.rows(); ++i) gram(i, i) += 1.0;
  return cholesky(gram);
}

GONIO_INLINE void require_positive_eta(double eta) {
  if (!(eta > 0.0 && std::isfinite(eta))) refuse("eta must be positive, not " + std::to_string(eta));
}

}  // namespace gonio::design::detail

namespace gonio::design {

GONIO_INLINE double d_optimality::operator()(const Eigen::MatrixXd& components) const {
  return -0.5 * detail::certainty(components, eta_).log_determinant();
}

GONIO_INLINE a_optimality::a_optimality(Eigen::VectorXd energies, double eta)
    : energies_(std::move(energies)), eta_(eta) {
  detail::require_positive_eta(eta);
  const auto possible = [](double energy) { return energy >= 0.0 && std::isfinite(energy); };
  if (!std::all_of(energies_.data(), energies_.data() + energies_.size(), possible) || !(energies_.sum() > 0.0))
    refuse("the components' squared norms must be finite, not negative, and not all zero");
}

GONIO_INLINE double a_optimality::operator()(const Eigen::MatrixXd& components) const {
  // (R'R + eta I)^-1 = (I - R' K^-1 R / eta) / eta with K = I + R R' / eta = L L'.
  const Eigen::MatrixXd known = detail::certainty(components, eta_).solve_lower(components);
  double sum = 0.0;
  for (Eigen::Index j = 0; j < known.cols(); ++j) sum += known.col(j).squaredNorm() * energies_[j];
  return 1.0 - sum / (eta_ * energies_.sum());
}

}  // namespace gonio::design
