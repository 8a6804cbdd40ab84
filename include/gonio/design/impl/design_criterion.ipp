#pragma once
/// Bodies of design/design_criterion.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/design/design_criterion.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <string>
#include <utility>

namespace gonio {

GONIO_INLINE double condition_number::operator()(const Eigen::MatrixXd& components) const {
  if (components.rows() == 1) return 1.0 / components.norm();
  const Eigen::MatrixXd gram = components.rows() <= components.cols()
                                   ? Eigen::MatrixXd(components * components.transpose())
                                   : Eigen::MatrixXd(components.transpose() * components);
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(gram, Eigen::EigenvaluesOnly).eigenvalues();
  const double smallest = values[0], largest = values[values.size() - 1];
  if (!(smallest > 1e-14 * largest)) return std::numeric_limits<double>::infinity();
  return std::sqrt(largest / smallest);
}

}  // namespace gonio

namespace gonio::detail {

GONIO_INLINE Eigen::LLT<Eigen::MatrixXd> certainty(const Eigen::MatrixXd& components, double eta) {
  Eigen::MatrixXd gram = components * components.transpose() / eta;
  gram.diagonal().array() += 1.0;
  return gram.llt();
}

GONIO_INLINE void require_positive_eta(double eta) {
  if (!(eta > 0.0 && std::isfinite(eta))) throw error("eta must be positive, not " + std::to_string(eta));
}

}  // namespace gonio::detail

namespace gonio {

GONIO_INLINE double d_optimality::operator()(const Eigen::MatrixXd& components) const {
  return -detail::certainty(components, eta_).matrixLLT().diagonal().array().log().sum();
}

GONIO_INLINE a_optimality::a_optimality(Eigen::VectorXd energies, double eta)
    : energies_(std::move(energies)), eta_(eta) {
  detail::require_positive_eta(eta);
  if (!energies_.allFinite() || !(energies_.array() >= 0.0).all() || !(energies_.sum() > 0.0))
    throw error("the components' energies must be finite, not negative, and not all zero");
}

GONIO_INLINE double a_optimality::operator()(const Eigen::MatrixXd& components) const {
  // (R'R + eta I)^-1 = (I - R' K^-1 R / eta) / eta with K = I + R R' / eta = L L'.
  const Eigen::MatrixXd known = detail::certainty(components, eta_).matrixL().solve(components);
  return 1.0 - (known.array().square().matrix() * energies_).sum() / (eta_ * energies_.sum());
}

}  // namespace gonio
