#pragma once
/// The reflectance of a smooth interface.

#include <algorithm>
#include <cmath>

namespace gonio {

/// Schlick's approximation: f0 + (1 - f0) (1 - cosine)^5. C. Schlick, "An Inexpensive BRDF Model for Physically-based
/// Rendering", EG 1994 (doi:10.1111/1467-8659.1330233); J. B. Nielsen's thesis (2016), Eq. 2.21.
template <class Real>
[[nodiscard]] Real fresnel_schlick(double cosine, const Real& f0) {
  const double rest = std::max(1.0 - cosine, 0.0);  // rounding can make a cosine exceed 1
  const double grazing = rest * rest * rest * rest * rest;
  return f0 * (1.0 - grazing) + grazing;
}

/// The reflectance of a smooth surface of refractive index n at normal incidence: ((1 - n) / (1 + n))^2, thesis Eq.
/// 2.21.
template <class Real>
[[nodiscard]] Real normal_reflectance(const Real& index) {
  const Real ratio = (1.0 - index) / (1.0 + index);
  return ratio * ratio;
}

/// Reflectance of a dielectric of relative index n >= 1, for unpolarised light from outside. R. L. Cook and K. E.
/// Torrance, "A Reflectance Model for Computer Graphics", ACM TOG 1982 (doi:10.1145/357290.357293), section 4.
template <class Real>
[[nodiscard]] Real fresnel_dielectric(double cosine, const Real& index) {
  using std::sqrt;
  const Real g = sqrt(Real(index * index + (cosine * cosine - 1.0)));
  const Real sum = g + cosine, difference = g - cosine;
  const Real parallel = (cosine * sum - 1.0) / (cosine * difference + 1.0);
  const Real across = difference / sum;
  return 0.5 * across * across * (1.0 + parallel * parallel);
}

/// Reflectance of a conductor with complex index n + ik, for unpolarised light from vacuum. M. Born and E. Wolf,
/// "Principles of Optics", section 14.2, written without complex numbers.
template <class Real>
[[nodiscard]] Real fresnel_conductor(double cosine, const Real& index, const Real& extinction) {
  using std::sqrt;
  const double squared_cosine = cosine * cosine, squared_sine = 1.0 - squared_cosine;
  const Real rest = index * index - extinction * extinction - squared_sine;
  const Real both = sqrt(Real(rest * rest + 4.0 * index * index * extinction * extinction));  // a^2 + b^2
  const Real a = sqrt(Real(0.5 * (both + rest)));
  const Real along = 2.0 * cosine * a;
  const Real across = (both - along + squared_cosine) / (both + along + squared_cosine);
  const Real far = squared_cosine * both + squared_sine * squared_sine, near = along * squared_sine;
  return 0.5 * across * (1.0 + (far - near) / (far + near));
}

}  // namespace gonio
