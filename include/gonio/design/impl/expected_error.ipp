#pragma once
/// Bodies of design/expected_error.hpp.

#include <gonio/basis/pca.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/design/design_criterion.hpp>
#include <gonio/design/expected_error.hpp>
#include <gonio/solve/row_source.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <cmath>
#include <utility>

namespace gonio {

GONIO_INLINE expected_error::rows expected_error::prepare(const Eigen::MatrixXd& components,
                                                          Eigen::VectorXd noise) const {
  rows measured(components.rows(), coefficients_.rows());
  measured.materials().noalias() = components * coefficients_.transpose();
  measured.weighted().noalias() = components * weighted_.transpose();
  measured.noise = std::move(noise);
  return measured;
}

GONIO_INLINE double expected_error::remainder::error(double noise) const {
  return squared_errors.max(0.0).sqrt().mean() + noise * std::sqrt(std::max(noise_energy, 0.0));
}

GONIO_INLINE expected_error::remainder expected_error::state(const rows& measured) const {
  const Eigen::Index n = measured.size();
  remainder left;
  left.squared_errors = energies_.array();
  left.noise_response = Eigen::VectorXd::Zero(coefficients_.rows());
  if (n == 0) return left;
  const auto y = measured.materials();
  Eigen::MatrixXd products(2 * n, n);
  products.noalias() = measured.both * y.transpose();
  Eigen::MatrixXd k = products.topRows(n);
  k.diagonal() += (options_.eta + measured.own_eta.array()).matrix();
  left.inverse = k.llt().solve(Eigen::MatrixXd::Identity(n, n));
  // b'W Y'b - 2 w . b = y . (K^-1 W Y' K^-1 y - 2 K^-1 w), for all observations by one product with Y and W.
  Eigen::MatrixXd factors(n, 2 * n);
  factors << left.inverse * products.bottomRows(n) * left.inverse, -2.0 * left.inverse;
  const auto spread = factors.leftCols(n);
  row_matrix changed(n, y.cols());
  changed.noalias() = factors * measured.both;
  left.squared_errors += changed.cwiseProduct(y).colwise().sum().transpose().array();
  left.own_variances = measured.own_eta / static_cast<double>(coefficients_.rows());
  if ((left.own_variances.array() > 0.0).any()) left.squared_errors += left.own_variances.dot(spread.diagonal());
  left.noise_response = y.transpose() * (left.inverse * measured.noise);
  left.noise_energy = measured.noise.dot(spread * measured.noise);
  return left;
}

}  // namespace gonio
