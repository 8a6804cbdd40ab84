#pragma once
/// Bodies of design/error_sweep.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/design/error_sweep.hpp>
#include <gonio/design/left_out_squares.hpp>
#include <gonio/solve/dense.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace gonio::design {

namespace detail {

using sweep_lanes = error_sweep::lanes;

[[nodiscard]] inline Eigen::Map<const sweep_lanes> lanes_at(const float* numbers) noexcept {
  return Eigen::Map<const sweep_lanes>(numbers);
}

/// Computes Y y and Y w for some measurements, whose rows of Y are interleaved in `rows`. As in `product_sum`, a
/// parameter pack keeps the sums in registers, where loops over arrays would keep them in memory.
template <std::size_t... J>
inline void project_lanes(const float* candidates, const float* rows, Eigen::Index observations, sweep_lanes* on_y,
                          sweep_lanes* on_w, std::index_sequence<J...> /*measurements*/) {
  constexpr Eigen::Index width = error_sweep::width;
  std::array<sweep_lanes, sizeof...(J)> y_sums{((void)J, sweep_lanes(sweep_lanes::Zero()))...}, w_sums = y_sums;
  for (Eigen::Index i = 0; i < observations; ++i, candidates += 2 * width, rows += sizeof...(J)) {
    const sweep_lanes y = lanes_at(candidates), w = lanes_at(candidates + width);
    ((y_sums[J] += y * rows[J]), ...);
    ((w_sums[J] += w * rows[J]), ...);
  }
  ((on_y[J] = y_sums[J]), ...);
  ((on_w[J] = w_sums[J]), ...);
}

/// Computes t = y - Y'a and u = w - W'a - Y'b for some observations, whose columns of Y and W are in `rows`. Adds y t
/// to d and y u to r.
template <std::size_t... I>
inline void take_away_lanes(const float* candidates, const float* rows, const sweep_lanes* a, const sweep_lanes* b,
                            Eigen::Index measurements, float* left, sweep_lanes& d, sweep_lanes& r,
                            std::index_sequence<I...> /*observations*/) {
  constexpr Eigen::Index width = error_sweep::width, together = sizeof...(I);
  std::array<sweep_lanes, together> t{sweep_lanes(lanes_at(candidates + 2 * width * I))...},
      u{sweep_lanes(lanes_at(candidates + 2 * width * I + width))...},
      more{((void)I, sweep_lanes(sweep_lanes::Zero()))...};
  for (Eigen::Index j = 0; j < measurements; ++j, rows += 2 * together) {
    const sweep_lanes once = a[j], twice = b[j];
    ((t[I] -= once * rows[I]), ...);
    ((u[I] -= once * rows[together + I]), ...);
    ((more[I] += twice * rows[I]), ...);
  }
  ((u[I] -= more[I]), ...);
  d += ((lanes_at(candidates + 2 * width * I) * t[I]) + ...);
  r += ((lanes_at(candidates + 2 * width * I) * u[I]) + ...);
  const auto store = [&](std::size_t i) {
    Eigen::Map<sweep_lanes>(left + 2 * width * i) = t[i];
    Eigen::Map<sweep_lanes>(left + 2 * width * i + width) = u[i];
  };
  (store(I), ...);
}

/// Computes F x, where `transposed` is the transpose of F.
inline void multiply_lanes(const Eigen::MatrixXf& transposed, const sweep_lanes* x, sweep_lanes* out) {
  for (Eigen::Index i = 0; i < transposed.cols(); ++i) {
    sweep_lanes sum = sweep_lanes::Zero();
    for (Eigen::Index j = 0; j < transposed.rows(); ++j) sum += transposed(j, i) * x[j];
    out[i] = sum;
  }
}

}  // namespace detail

GONIO_INLINE error_sweep::error_sweep(const expected_error& criterion, const expected_error::rows& measured)
    : measurements_(measured.size()),
      observations_(measured.both.cols()),
      eta_(static_cast<float>(criterion.options().eta)),
      common_shift_(static_cast<float>(criterion.options().common_shift)),
      channels_(criterion.channels()) {
  const expected_error::remainder left = criterion.state(measured);
  const Eigen::Index n = measurements_, m = observations_;
  const auto y = measured.materials(), w = measured.weighted();
  by_measurement_.setZero(measurements_together, (n + measurements_together - 1) / measurements_together * m);
  by_observation_.setZero(2 * observations_together, columns(m) / observations_together * n);
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = 0; i < m; ++i) {
      by_measurement_(j % measurements_together, j / measurements_together * m + i) = static_cast<float>(y(j, i));
      auto column = by_observation_.col(i / observations_together * n + j);
      column[i % observations_together] = static_cast<float>(y(j, i));
      column[observations_together + i % observations_together] = static_cast<float>(w(j, i));
    }
  inverse_ = to_float(left.inverse);
  if (n > 0) cross_ = to_float(product(w, y.transpose()));  // transposed; K^-1 is symmetric
  squared_errors_ = left.squared_errors.cast<float>();
  inverse_unknown_ = left.inverse_unknown.cast<float>();
  missed_ = left.missed.cast<float>();
  own_variances_ = left.own_variances.cast<float>();
  noise_response_ = left.noise_response.cast<float>();
  weighted_response_.resize(n);
  for (Eigen::Index j = 0; j < n; ++j) weighted_response_[j] = static_cast<float>(w.row(j).dot(left.noise_response));
  noise_energy_ = static_cast<float>(left.noise_energy);
  own_energy_ = static_cast<float>(left.own_energy);
}

GONIO_INLINE void error_sweep::operator()(const tiles& candidates, Eigen::Index first,
                                          std::span<const lanes> sample_noise_penalties,
                                          std::span<lanes> errors) const {
  const Eigen::Index n = measurements_, groups = by_measurement_.cols() / std::max<Eigen::Index>(observations_, 1);
  found of;
  for (auto* sums : {&of.on_y, &of.on_w}) sums->resize(static_cast<std::size_t>(groups * measurements_together));
  for (auto* known : {&of.once, &of.twice}) known->resize(static_cast<std::size_t>(n));
  of.left.resize(2 * width, columns(observations_));
  for (std::size_t number = 0; number < errors.size(); ++number) {
    const float* tile = candidates.col(first + static_cast<Eigen::Index>(number) * columns(observations_)).data();
    project(tile, of);
    of.d = eta_ + sample_noise_penalties[number];
    take_away(tile, of);
    const lanes grown = own_growth(of, sample_noise_penalties[number]);
    if (missed_.size() == 0)
      errors[number] = mean(of, grown);
    else if (const lanes own = own_energy_ + grown;
             channels_ == 3)  // a constant number of channels is unrolled into registers
      errors[number] = mean_of_excluded(std::integral_constant<Eigen::Index, 3>(), of, own);
    else
      errors[number] = mean_of_excluded(channels_, of, own);
    if (common_shift_ > 0.0f) errors[number] += shift(tile, of);
  }
}

GONIO_INLINE void error_sweep::project(const float* tile, found& of) const {
  for (Eigen::Index j = 0; j < measurements_; j += measurements_together)
    detail::project_lanes(tile, by_measurement_.data() + j * observations_, observations_, &of.on_y[j], &of.on_w[j],
                          std::make_index_sequence<measurements_together>());
  detail::multiply_lanes(inverse_, of.on_y.data(), of.once.data());
  for (Eigen::Index j = 0; j < measurements_; ++j)
    for (Eigen::Index k = 0; k < measurements_; ++k) of.on_w[j] -= cross_(k, j) * of.once[k];
  detail::multiply_lanes(inverse_, of.on_w.data(), of.twice.data());
}

GONIO_INLINE void error_sweep::take_away(const float* tile, found& of) const {
  of.r.setZero();
  for (Eigen::Index i = 0; i < of.left.cols(); i += observations_together)
    detail::take_away_lanes(tile + i * 2 * width, by_observation_.data() + i * 2 * measurements_, of.once.data(),
                            of.twice.data(), measurements_, of.left.col(i).data(), of.d, of.r,
                            std::make_index_sequence<observations_together>());
}

/// Returns the increase of each squared error due to the measurements' own errors.
GONIO_INLINE error_sweep::lanes error_sweep::own_growth(const found& of, const lanes& sample_noise_penalty) const {
  lanes squares = sample_noise_penalty / static_cast<float>(observations_), products = lanes::Zero();
  for (Eigen::Index j = 0; j < measurements_; ++j) {
    const lanes known_once = own_variances_[j] * of.once[j];
    squares += known_once * of.once[j];
    products += known_once * of.twice[j];
  }
  return squares * of.r / (of.d * of.d) - 2.0f * products / of.d;
}

GONIO_INLINE error_sweep::lanes error_sweep::mean(const found& of, const lanes& grown) const {
  const lanes along = of.r / (of.d * of.d), across = 2.0f / of.d;
  lanes sum = lanes::Zero();
  const float* at = of.left.data();
  for (Eigen::Index i = 0; i < observations_; ++i, at += 2 * width) {
    const lanes t = detail::lanes_at(at), u = detail::lanes_at(at + width);
    sum += (squared_errors_[i] + (grown + t * (along * t - across * u))).max(0.0f).sqrt();
  }
  return sum / static_cast<float>(observations_);
}

/// Returns the mean error over all observations if materials are left out.
template <class Channels>
error_sweep::lanes error_sweep::mean_of_excluded(Channels channels, const found& of, const lanes& own) const {
  std::vector<lanes> room(static_cast<std::size_t>(2 * channels));
  lanes sum = lanes::Zero();
  for (Eigen::Index first = 0; first < missed_.cols(); first += channels) {
    const float* at = of.left.col(first).data();
    const detail::left_out_material<lanes, float> material{&inverse_unknown_(0, first), &missed_(0, first),
                                                           room.data()};
    sum += detail::sum_of_left_out_errors(
        channels, material, [&](Eigen::Index c) { return detail::lanes_at(at + 2 * width * c); },
        [&](Eigen::Index c) { return detail::lanes_at(at + 2 * width * c + width); }, of.d, of.r, own);
  }
  return sum / static_cast<float>(observations_);
}

/// Returns the contribution of a shift that is common to all samples. The candidate q changes the response (SQ)+_eta 1
/// by A q (1 - q . (SQ)+_eta 1) / d.
GONIO_INLINE error_sweep::lanes error_sweep::shift(const float* tile, const found& of) const {
  lanes growth = lanes::Ones(), along = lanes::Zero();
  for (Eigen::Index i = 0; i < observations_; ++i, tile += 2 * width) {
    growth -= detail::lanes_at(tile) * noise_response_[i];
    along += detail::lanes_at(tile + width) * noise_response_[i];
  }
  for (Eigen::Index j = 0; j < measurements_; ++j) along -= of.once[j] * weighted_response_[j];
  growth /= of.d;
  return common_shift_ * (noise_energy_ + growth * (2.0f * along + growth * of.r)).max(0.0f).sqrt();
}

}  // namespace gonio::design
