#pragma once
/// Arc tangents by one polynomial, which a compiler can evaluate for several numbers at once: for inner loops.

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <type_traits>

namespace gonio::detail {

/// Returns the coefficients of atan(t) / (t pi / 2) in powers of t^2, for t from 0 to 1. The polynomials have the least
/// maximum relative error (Remez's exchange): 1.6e-8 with nine coefficients and 4e-14 with sixteen.
template <std::floating_point Real>
[[nodiscard]] constexpr auto arc_tangent_coefficients() noexcept {
  if constexpr (std::is_same_v<Real, float>)
    return std::array{0.63661976267128062f,   -0.21220493590025488f,  0.12727697243467709f,
                      -0.090423238894346059f, 0.067742390452809123f,  -0.047774008311915736f,
                      0.027178457024947675f,  -0.010229711189611097f, 0.0018143193278700326f};
  else
    return std::array<Real, 16>{
        0.63661977236755674,   -0.21220659077617143,   0.12732395332815763,   -0.090945641777750885,
        0.070734792970602658,  -0.057866243053599047,  0.048909067653282588,  -0.042119398916901266,
        0.036225067310717535,  -0.030025117664704646,  0.022718242161347414,  -0.014672689963069845,
        0.0075033769833896553, -0.0027784904318869678, 0.0006519744249023101, -7.2074615891761176e-05};
}

/// Returns atan(t) / (t pi / 2), given t^2 from 0 to 1. Even and odd powers are summed separately, which halves the
/// chain of dependent operations.
template <std::floating_point Real>
[[nodiscard]] inline Real arc_tangent_over_tangent(Real squared) noexcept {
  constexpr auto c = arc_tangent_coefficients<Real>();
  constexpr Eigen::Index count = c.size();
  const Real fourth = squared * squared;
  Real last = c[count - 1], before = c[count - 2];
  for (Eigen::Index i = count - 3; i >= 0; i -= 2) {
    last = last * fourth + c[i];
    if (i > 0) before = before * fourth + c[i - 1];
  }
  return count % 2 == 0 ? last * squared + before : before * squared + last;
}

/// Returns 1 if a > b, otherwise 0, without a branch: the hardware could not predict it.
template <std::floating_point Real>
[[nodiscard]] inline Real is_more(Real a, Real b) noexcept {
  return Real(0.5) - std::copysign(Real(0.5), b - a);
}

/// Returns an angle as a share of a quarter turn. `tangent` is the angle's tangent if `steep` is 0, and the reciprocal
/// of the tangent if `steep` is 1. `squared` is the square of `tangent`.
template <std::floating_point Real>
[[nodiscard]] inline Real quarter_turns(Real tangent, Real squared, Real steep) noexcept {
  // Computes 1 - share or share without a branch, which the hardware could not predict.
  return std::abs(steep - tangent * arc_tangent_over_tangent(squared));
}

/// An azimuth folded to half a turn: its tangent and its sector.
template <std::floating_point Real>
struct azimuth_terms {
  Real tangent;  ///< the tangent or its reciprocal, whichever is at most 1
  Real steep;    ///< 1 if the azimuth is more than pi / 4 from the x axis, otherwise 0
  Real left;     ///< 1 if the azimuth is in the second quadrant, otherwise 0

  azimuth_terms(Real x, Real y) noexcept {
    const Real side = std::abs(x), up = std::abs(y);
    tangent = std::min(side, up) / (std::max(side, up) + std::numeric_limits<Real>::min());
    steep = is_more(up, side);
    left = Real(0.5) - std::copysign(Real(0.5), x) * std::copysign(Real(1), y);
  }
};

/// Returns an azimuth as a share of half a turn, from 0 to 1 (1 is equivalent to 0), given its angle from the x axis as
/// a share of a quarter turn.
template <std::floating_point Real>
[[nodiscard]] inline Real half_turns(Real quarter, Real left) noexcept {
  return std::abs(left - quarter / 2);
}

}  // namespace gonio::detail
