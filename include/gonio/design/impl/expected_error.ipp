#pragma once
/// Bodies of design/expected_error.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/design/expected_error.hpp>
#include <gonio/solve/dense.hpp>
#include <gonio/solve/float_product.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace gonio {

GONIO_INLINE expected_error::expected_error(const Eigen::MatrixXf& coefficients, const expected_error_options& options,
                                            const Eigen::MatrixXd& norm)
    : options_(options), coefficients_(coefficients.cast<double>()) {
  detail::require_positive_eta(options.eta);
  if (!(options.noise >= 0.0 && std::isfinite(options.noise)))
    throw error("the noise must be finite and not negative, not " + std::to_string(options.noise));
  const Eigen::Index k = coefficients.cols();
  if (norm.rows() != k || norm.cols() != k)
    throw error("a norm of " + std::to_string(k) + " weights must be a square matrix of as many rows");
  weighted_ = product(coefficients_, norm);
  energies_ = Eigen::VectorXd::Zero(coefficients_.rows());
  for (Eigen::Index j = 0; j < k; ++j) energies_ += coefficients_.col(j).cwiseProduct(weighted_.col(j));
}

GONIO_INLINE expected_error::rows expected_error::prepare(const Eigen::MatrixXd& components,
                                                          Eigen::VectorXd noise) const {
  // A row of Y or W is a column of its transpose, whose product copies but the few rows of the components.
  rows measured(components.rows(), coefficients_.rows());
  const Eigen::MatrixXd transposed = components.transpose();
  measured.materials().transpose() = product(coefficients_, transposed);
  measured.weighted().transpose() = product(weighted_, transposed);
  measured.noise = std::move(noise);
  return measured;
}

GONIO_INLINE expected_error::rows expected_error::prepare(const Eigen::MatrixXd& components) const {
  return prepare(components, Eigen::VectorXd::Ones(components.rows()));
}

GONIO_INLINE double expected_error::remainder::error(double noise) const {
  double sum = 0.0;
  for (const double squared : squared_errors) sum += std::sqrt(std::max(squared, 0.0));
  return sum / static_cast<double>(squared_errors.size()) + noise * std::sqrt(std::max(noise_energy, 0.0));
}

GONIO_INLINE expected_error::remainder expected_error::state(const rows& measured) const {
  const Eigen::Index n = measured.size(), m = coefficients_.rows();
  remainder left;
  left.squared_errors = energies_;
  left.noise_response = Eigen::VectorXd::Zero(m);
  if (n == 0) return left;
  const matrix_view both = measured.both.transpose();  // Y' beside W': m x 2n
  const Eigen::MatrixXd products = product(measured.materials(), both);
  Eigen::MatrixXd k = products.leftCols(n);
  for (Eigen::Index i = 0; i < n; ++i) k(i, i) += options_.eta + measured.own_eta[i];
  left.inverse = cholesky(k).solve(Eigen::MatrixXd::Identity(n, n));
  // b'W Y'b - 2 w . b = y . (K^-1 W Y' K^-1 y - 2 K^-1 w), for all observations by one product with Y and W.
  const Eigen::MatrixXd spread = product(left.inverse, product(products.rightCols(n), left.inverse));
  Eigen::MatrixXd factors(2 * n, n);
  factors.topRows(n) = spread;
  factors.bottomRows(n) = -2.0 * left.inverse;
  const Eigen::MatrixXd changed = product(both, factors);
  Eigen::VectorXd change = Eigen::VectorXd::Zero(m);
  for (Eigen::Index i = 0; i < n; ++i) change += changed.col(i).cwiseProduct(both.col(i));
  left.squared_errors += change;
  left.own_variances = measured.own_eta / static_cast<double>(m);
  double own = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) own += left.own_variances[i] * spread(i, i);
  for (double& squared : left.squared_errors) squared += own;
  for (Eigen::Index i = 0; i < n; ++i) {
    left.noise_response += left.inverse.col(i).dot(measured.noise) * both.col(i);
    left.noise_energy += measured.noise[i] * spread.col(i).dot(measured.noise);
  }
  return left;
}

template <class Scalar>
extended_error<Scalar>::extended_error(const expected_error& criterion, const expected_error::rows& measured)
    : eta_(static_cast<Scalar>(criterion.options().eta)), noise_(static_cast<Scalar>(criterion.options().noise)) {
  const expected_error::remainder left = criterion.state(measured);
  const Eigen::Index n = measured.size(), m = measured.both.cols();
  both_.resize(2 * m, n);
  y_.resize(n, m);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < m; ++j) {
      both_(j, i) = y_(i, j) = static_cast<Scalar>(measured.both(i, j));
      both_(m + j, i) = static_cast<Scalar>(measured.both(n + i, j));
    }
  minus_inverse_ = -left.inverse.template cast<Scalar>();
  squared_errors_ = left.squared_errors.template cast<Scalar>();
  own_variances_ = left.own_variances.template cast<Scalar>();
  noise_response_ = left.noise_response.template cast<Scalar>();
  noise_energy_ = static_cast<Scalar>(left.noise_energy);
}

template <class Scalar>
auto extended_error<Scalar>::take_away(columns& both, columns& twice) const -> knowledge {
  const Eigen::Index m = y_.cols();
  knowledge known;
  if (y_.rows() > 0) {
    known.once = product(minus_inverse_, product(y_, both.topRows(m)));
    add_product(both_, known.once, both);
  }
  twice = both.bottomRows(m);
  if (y_.rows() > 0) {
    known.twice = product(minus_inverse_, product(y_, twice));
    add_product(both_.topRows(m), known.twice, twice);
  }
  return known;
}

template <class Scalar>
auto extended_error<Scalar>::operator()(const Eigen::Ref<const matrix>& y, const Eigen::Ref<const matrix>& w,
                                        const Eigen::Ref<const column>& own_eta) const -> column {
  const Eigen::Index m = y.cols();
  columns both(2 * m, y.rows()), twice;
  both.topRows(m) = y.transpose();
  both.bottomRows(m) = w.transpose();
  const knowledge known = take_away(both, twice);
  column found(y.rows());
  for (Eigen::Index i = 0; i < y.rows(); ++i) {
    const auto t = both.col(i).head(m), once = both.col(i).tail(m);
    const Scalar d = eta_ + own_eta[i] + y.row(i).dot(t), r = t.dot(once);
    const Scalar grown = own_growth(known, i, own_eta[i], d, r);
    const auto change = t.array() * (r / (d * d) * t.array() - Scalar(2) / d * twice.col(i).array());
    found[i] = (squared_errors_ + (grown + change)).max(Scalar(0)).sqrt().mean();
    if (!(noise_ > Scalar(0))) continue;
    // (SQ)+_eta 1 grows by A q (1 - q . (SQ)+_eta 1) / d.
    const Scalar growth = (Scalar(1) - y.row(i).dot(noise_response_)) / d, along = once.dot(noise_response_);
    found[i] += noise_ * std::sqrt(std::max(noise_energy_ + growth * (Scalar(2) * along + growth * r), Scalar(0)));
  }
  return found;
}

/// By how much errors of their own add to each squared error, beyond what they do now.
template <class Scalar>
Scalar extended_error<Scalar>::own_growth(const knowledge& known, Eigen::Index candidate, Scalar own_eta, Scalar d,
                                          Scalar r) const {
  Scalar squares = own_eta / static_cast<Scalar>(squared_errors_.size()), products = Scalar(0);
  for (Eigen::Index i = 0; i < y_.rows(); ++i) {
    const Scalar known_once = own_variances_[i] * known.once(i, candidate);
    squares += known_once * known.once(i, candidate);
    products += known_once * known.twice(i, candidate);
  }
  return squares * r / (d * d) - Scalar(2) * products / d;
}

}  // namespace gonio
