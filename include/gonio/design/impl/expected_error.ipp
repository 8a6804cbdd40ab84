#pragma once
/// Bodies of design/expected_error.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/design/expected_error.hpp>
#include <gonio/design/left_out_squares.hpp>
#include <gonio/solve/dense.hpp>
#include <gonio/solve/float_product.hpp>
#include <gonio/solve/semidefinite.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace gonio::design {

GONIO_INLINE expected_error::expected_error(const Eigen::MatrixXf& coefficients, Eigen::Index channels,
                                            const expected_error_options& options, const Eigen::MatrixXd& norm)
    : options_(options), channels_(channels), coefficients_(coefficients.cast<double>()) {
  detail::require_positive_eta(options.eta);
  for (const auto& [name, value] : {std::pair{"noise", options.noise}, {"common shift", options.common_shift}})
    if (!(value >= 0.0 && std::isfinite(value)))
      refuse({"the ", name, " must be finite and not negative, not ", value});
  if (options.leave_out && coefficients.rows() < 2 * channels)
    refuse("leaving out a material needs at least two materials");
  const Eigen::Index k = coefficients.cols();
  if (norm.rows() != k || norm.cols() != k)
    refuse("a norm of " + std::to_string(k) + " weights must be a matrix with " + std::to_string(k) +
           " rows and columns");
  weighted_ = product(coefficients_, norm);
  energies_ = Eigen::VectorXd::Zero(coefficients_.rows());
  for (Eigen::Index j = 0; j < k; ++j) energies_ += coefficients_.col(j).cwiseProduct(weighted_.col(j));
}

GONIO_INLINE expected_error::rows expected_error::prepare(const Eigen::MatrixXd& components,
                                                          Eigen::VectorXd noise) const {
  // A row of Y or W is a column of its transpose. Computing the transposes copies only the few rows of the components.
  rows measured(components.rows(), coefficients_.rows());
  const Eigen::MatrixXd transposed = components.transpose();
  measured.materials().transpose() = product(coefficients_, transposed);
  measured.weighted().transpose() = product(weighted_, transposed);
  measured.noise = std::move(noise);
  measured.sample_noise_penalty.setConstant(noise_eta());
  return measured;
}

GONIO_INLINE expected_error::rows expected_error::prepare(const Eigen::MatrixXd& components) const {
  return prepare(components, Eigen::VectorXd::Ones(components.rows()));
}

GONIO_INLINE double expected_error::remainder::error(double common_shift) const {
  double sum = 0.0;
  for (const double squared : squared_errors) sum += std::sqrt(std::max(squared, 0.0));
  return sum / static_cast<double>(squared_errors.size()) + common_shift * std::sqrt(std::max(noise_energy, 0.0));
}

GONIO_INLINE expected_error::remainder expected_error::state(const rows& measured) const {
  const Eigen::Index n = measured.size(), m = coefficients_.rows();
  // Without measurements, nothing of an observation is known, and its squared error is its energy c_i'M c_i.
  remainder left;
  left.squared_errors = energies_;
  left.noise_response = Eigen::VectorXd::Zero(m);
  if (n == 0) {
    if (options_.leave_out) leave_each_out(measured, Eigen::MatrixXd(m, 0), Eigen::MatrixXd(m, 0), left);
    return left;
  }
  const matrix_view both = measured.both.transpose();  // Y' beside W': m x 2n
  // Invert K = Y Y' + eta I + the penalty of each measurement's own error.
  const Eigen::MatrixXd products = product(measured.materials(), both);
  Eigen::MatrixXd k = products.leftCols(n);
  for (Eigen::Index i = 0; i < n; ++i) k(i, i) += options_.eta + measured.sample_noise_penalty[i];
  left.inverse = cholesky(k).inverse();
  // Add the (negative) change of each observation's squared error by the measurements: b'W Y'b - 2 w . b = y . (K^-1 W
  // Y' K^-1 y - 2 K^-1 w), for all observations by one product with Y and W.
  const Eigen::MatrixXd spread = product(left.inverse, product(products.rightCols(n), left.inverse));
  Eigen::MatrixXd factors(2 * n, n);
  factors.topRows(n) = spread;
  factors.bottomRows(n) = -2.0 * left.inverse;
  const Eigen::MatrixXd changed = product(both, factors);
  Eigen::VectorXd change = Eigen::VectorXd::Zero(m);
  for (Eigen::Index i = 0; i < n; ++i) change += changed.col(i).cwiseProduct(both.col(i));
  left.squared_errors += change;
  // Leave each material out of the basis that reconstructs it.
  if (options_.leave_out) {
    const matrix_view y = both.leftCols(n);
    leave_each_out(measured, product(y, left.inverse), product(y, spread), left);
  }
  // Add the contribution of the measurements' own errors.
  left.own_variances = measured.sample_noise_penalty / static_cast<double>(m);
  for (Eigen::Index i = 0; i < n; ++i) left.own_energy += left.own_variances[i] * spread(i, i);
  for (double& squared : left.squared_errors) squared += left.own_energy;
  // Compute the response to a common shift.
  for (Eigen::Index i = 0; i < n; ++i) {
    left.noise_response += left.inverse.col(i).dot(measured.noise) * both.col(i);
    left.noise_energy += measured.noise[i] * spread.col(i).dot(measured.noise);
  }
  return left;
}

GONIO_INLINE void expected_error::leave_each_out(const rows& measured, const Eigen::MatrixXd& known,
                                                 const Eigen::MatrixXd& spread, remainder& left) const {
  const Eigen::Index m = coefficients_.rows();
  left.inverse_unknown.resize(channels_, m);
  left.missed.resize(channels_, m);
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(channels_, channels_);
  const auto y = measured.materials(), w = measured.weighted();
  Eigen::MatrixXd x(channels_, channels_), l(channels_, channels_);
  for (Eigen::Index first = 0; first < m; first += channels_) {
    for (Eigen::Index p = 0; p < channels_; ++p)
      for (Eigen::Index q = 0; q <= p; ++q) {
        const Eigen::Index a = first + p, b = first + q;
        double missed = coefficients_.row(a).dot(weighted_.row(b)), known_of = 1.0 / static_cast<double>(m);
        for (Eigen::Index i = 0; i < measured.size(); ++i) {
          missed += spread(a, i) * y(i, b) - known(a, i) * w(i, b) - known(b, i) * w(i, a);
          known_of += known(a, i) * y(i, b);
        }
        x(p, q) = x(q, p) = missed;
        l(p, q) = (p == q ? 1.0 : 0.0) - known_of;
      }
    const Eigen::MatrixXd inverse = solve_semidefinite(l, identity), all = product(inverse, product(x, inverse));
    left.inverse_unknown.middleCols(first, channels_) = inverse;
    left.missed.middleCols(first, channels_) = all;
    for (Eigen::Index c = 0; c < channels_; ++c) left.squared_errors[first + c] = all(c, c);
  }
}

template <class Scalar>
extended_error<Scalar>::extended_error(const expected_error& criterion, const expected_error::rows& measured)
    : eta_(static_cast<Scalar>(criterion.options().eta)),
      common_shift_(static_cast<Scalar>(criterion.options().common_shift)),
      channels_(criterion.channels()) {
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
  inverse_unknown_ = left.inverse_unknown.template cast<Scalar>();
  missed_ = left.missed.template cast<Scalar>();
  own_variances_ = left.own_variances.template cast<Scalar>();
  noise_response_ = left.noise_response.template cast<Scalar>();
  noise_energy_ = static_cast<Scalar>(left.noise_energy);
  own_energy_ = static_cast<Scalar>(left.own_energy);
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
                                        const Eigen::Ref<const column>& sample_noise_penalty) const -> column {
  const Eigen::Index m = y.cols();
  columns both(2 * m, y.rows()), twice;
  both.topRows(m) = y.transpose();
  both.bottomRows(m) = w.transpose();
  const knowledge known = take_away(both, twice);
  column found(y.rows());
  for (Eigen::Index i = 0; i < y.rows(); ++i) {
    const auto t = both.col(i).head(m), once = both.col(i).tail(m);
    const Scalar d = eta_ + sample_noise_penalty[i] + y.row(i).dot(t), r = t.dot(once);
    const Scalar grown = own_growth(known, i, sample_noise_penalty[i], d, r);
    if (missed_.size() > 0) {
      found[i] = mean_of_excluded(&both(0, i), &twice(0, i), d, r, own_energy_ + grown);
    } else {
      const auto change = t.array() * (r / (d * d) * t.array() - Scalar(2) / d * twice.col(i).array());
      found[i] = (squared_errors_ + (grown + change)).max(Scalar(0)).sqrt().mean();
    }
    if (!(common_shift_ > Scalar(0))) continue;
    // The candidate q changes the response (SQ)+_eta 1 by A q (1 - q . (SQ)+_eta 1) / d.
    const Scalar growth = (Scalar(1) - y.row(i).dot(noise_response_)) / d, along = once.dot(noise_response_);
    found[i] +=
        common_shift_ * std::sqrt(std::max(noise_energy_ + growth * (Scalar(2) * along + growth * r), Scalar(0)));
  }
  return found;
}

template <class Scalar>
Scalar extended_error<Scalar>::mean_of_excluded(const Scalar* t, const Scalar* w, Scalar d, Scalar r,
                                                Scalar own) const {
  const Eigen::Index m = missed_.cols();
  std::vector<Scalar> room(static_cast<std::size_t>(2 * channels_));
  Scalar sum = Scalar(0);
  for (Eigen::Index first = 0; first < m; first += channels_) {
    const detail::left_out_material<Scalar, Scalar> material{&inverse_unknown_(0, first), &missed_(0, first),
                                                             room.data()};
    sum += detail::sum_of_left_out_errors(
        channels_, material, [&](Eigen::Index c) { return t[first + c]; }, [&](Eigen::Index c) { return w[first + c]; },
        d, r, own);
  }
  return sum / static_cast<Scalar>(m);
}

/// Returns the increase of each squared error due to the measurements' own errors.
template <class Scalar>
Scalar extended_error<Scalar>::own_growth(const knowledge& known, Eigen::Index candidate, Scalar sample_noise_penalty,
                                          Scalar d, Scalar r) const {
  Scalar squares = sample_noise_penalty / static_cast<Scalar>(squared_errors_.size()), products = Scalar(0);
  for (Eigen::Index i = 0; i < y_.rows(); ++i) {
    const Scalar known_once = own_variances_[i] * known.once(i, candidate);
    squares += known_once * known.once(i, candidate);
    products += known_once * known.twice(i, candidate);
  }
  return squares * r / (d * d) - Scalar(2) * products / d;
}

}  // namespace gonio::design
