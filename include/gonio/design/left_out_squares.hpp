#pragma once
/// The errors of a material that is left out of the basis, after one more measurement. `extended_error` computes them
/// for one candidate, `error_sweep` for several at once.

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace gonio::design::detail {

/// Returns the square root of max(square, 0), because rounding can make a square negative.
template <class Number>
[[nodiscard]] inline Number root_of_positive(const Number& square) {
  if constexpr (std::is_arithmetic_v<Number>)
    return std::sqrt(std::max(square, Number(0)));
  else
    return square.max(0).sqrt();
}

/// The state of a left-out material before one more measurement: G = L^-1 and Z = L^-1 X L^-1 of `expected_error`,
/// channels x channels each. `room` is work space for two numbers per channel.
template <class Number, class Scalar>
struct left_out_material {
  const Scalar* inverse;
  const Scalar* missed;
  Number* room;
};

/// Returns the sum over a material's channels of the root errors after one more measurement. `own` is added to each
/// squared error. The measurement reduces L by t t' / d and X by (t u' + u t') / d - t t' r / d^2. By Sherman and
/// Morrison, with p = G t, g = Z t - G u and a = d - t'p, the diagonal of L^-1 X L^-1 becomes Z_ii + 2 p_i g_i / a +
/// p_i^2 (t'g - p'u + r) / a^2. O(channels^2). `t(i)` and `u(i)` are the values of channel i.
template <class Channels, class Number, class Scalar, class OfT, class OfU>
[[nodiscard]] inline Number sum_of_left_out_errors(const Channels channels,
                                                   const left_out_material<Number, Scalar>& material, const OfT& t,
                                                   const OfU& u, const Number& d, const Number& r, const Number& own) {
  Number a = d, energy = r;
  Number *const p = material.room, *const g = p + channels;
  for (Eigen::Index i = 0; i < channels; ++i) {
    const Scalar *const inverse = material.inverse + i * channels, *const missed = material.missed + i * channels;
    p[i] = inverse[0] * t(0);
    g[i] = missed[0] * t(0) - inverse[0] * u(0);
    for (Eigen::Index j = 1; j < channels; ++j) {
      p[i] += inverse[j] * t(j);
      g[i] += missed[j] * t(j) - inverse[j] * u(j);
    }
    a -= t(i) * p[i];
    energy += t(i) * g[i] - u(i) * p[i];
  }
  const Number scale = Scalar(1) / a, along = energy * scale * scale, twice = Scalar(2) * scale;
  const auto error_of = [&](Eigen::Index i) -> Number {
    const Number square = material.missed[i * channels + i] + own + p[i] * (twice * g[i] + along * p[i]);
    return root_of_positive(square);
  };
  Number sum = error_of(0);
  for (Eigen::Index i = 1; i < channels; ++i) sum += error_of(i);
  return sum;
}

}  // namespace gonio::design::detail
