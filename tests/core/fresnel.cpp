#include <gonio/core/fresnel.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <complex>

namespace {

/// Fresnel's amplitudes in complex numbers, squared and averaged.
double by_amplitudes(double cosine, std::complex<double> index) {
  const std::complex<double> inside = std::sqrt(1.0 - (1.0 - cosine * cosine) / (index * index));
  const auto across = (cosine - index * inside) / (cosine + index * inside);
  const auto along = (index * cosine - inside) / (index * cosine + inside);
  return 0.5 * (std::norm(across) + std::norm(along));
}

}  // namespace

TEST_CASE("dielectrics and conductors are Fresnel's amplitudes") {
  CHECK(rc::check([] {
    const double cosine = 1e-4 * *rc::gen::inRange(1, 10'001), n = 1.0 + 1e-3 * *rc::gen::inRange(10, 3'000),
                 k = 1e-3 * *rc::gen::inRange(0, 5'000);
    RC_ASSERT(std::abs(gonio::fresnel_dielectric(cosine, n) - by_amplitudes(cosine, n)) < 1e-12);
    RC_ASSERT(std::abs(gonio::fresnel_conductor(cosine, n, k) - by_amplitudes(cosine, {n, k})) < 1e-9);
    RC_ASSERT(std::abs(gonio::fresnel_conductor(cosine, n, 0.0) - gonio::fresnel_dielectric(cosine, n)) < 1e-9);
  }));
}

TEST_CASE("at normal incidence and at grazing angles") {
  for (const double n : {1.1, 1.5, 2.4}) {
    CAPTURE(n);
    CHECK(gonio::fresnel_dielectric(1.0, n) == doctest::Approx(gonio::normal_reflectance(n)));
    CHECK(gonio::fresnel_dielectric(0.0, n) == doctest::Approx(1.0));
    CHECK(gonio::fresnel_schlick(1.0, gonio::normal_reflectance(n)) == doctest::Approx(gonio::normal_reflectance(n)));
    CHECK(gonio::fresnel_schlick(0.0, gonio::normal_reflectance(n)) == doctest::Approx(1.0));
  }
  // For glass, the error of Schlick's approximation is below 0.04.
  for (double cosine = 0.0; cosine <= 1.0; cosine += 0.01)
    CHECK(std::abs(gonio::fresnel_schlick(cosine, 0.04) - gonio::fresnel_dielectric(cosine, 1.5)) < 0.04);
  // Gold at 550 nm.
  CHECK(gonio::fresnel_conductor(1.0, 0.43, 2.455) == doctest::Approx(0.786).epsilon(0.01));
}
