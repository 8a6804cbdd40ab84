#include <gonio/capture/relative_reflectance.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <limits>
#include <random>

using gonio::capture::illumination;
using gonio::capture::reference_light;
using gonio::capture::uncertain;

TEST_CASE("solid angle of a pixel: Eq. 4 and 5, and a sphere seen from its centre") {
  // D = 50 / 2 = 25 mm at 350 mm.
  const double half = std::atan(25.0 / 700.0);
  CHECK(gonio::capture::pixel_solid_angle(50.0, 2.0, 350.0) ==
        doctest::Approx(2.0 * std::numbers::pi * (1.0 - std::cos(half))).epsilon(1e-9));
  CHECK(gonio::capture::pixel_half_angle(50.0, 2.0, 350.0) == doctest::Approx(half));
  CHECK(gonio::capture::pixel_solid_angle(1.0, 1.0, 1e9) == doctest::Approx(std::numbers::pi / 4.0 * 1e-18));
  CHECK(gonio::capture::pixel_solid_angle(1e9, 1.0, 1e-9) == doctest::Approx(2.0 * std::numbers::pi));
  CHECK_THROWS_WITH_AS(gonio::capture::pixel_solid_angle(0.0, 1.0, 1.0), doctest::Contains("must be positive"),
                       gonio::error);
}

TEST_CASE("relative reflectance: f = dL / dE wherever lamp, reference and material are") {
  CHECK(rc::check("a material of any BRDF comes back", [] {
    const auto number = [](int from, int to) { return *rc::gen::inRange(from, to) / 100.0; };
    const double f = number(1, 300), lamp = number(10, 1000), rho = number(50, 101), camera = number(10, 1000);
    const illumination at_reference{number(5, 101), number(50, 200)}, at_material{number(5, 101), number(50, 200)};
    const auto irradiance = [&](const illumination& at) { return lamp * at.cosine / (at.distance * at.distance); };
    // The camera's signal is proportional to radiance.
    const uncertain reference{camera * rho / std::numbers::pi * irradiance(at_reference), 0.0};
    const uncertain material{camera * f * irradiance(at_material), 0.0};
    const auto found = reference_light(reference, rho, at_reference).brdf(material, at_material);
    RC_ASSERT(std::abs(found.value / f - 1.0) < 1e-12);
    RC_ASSERT(found.deviation == 0.0);
  }));
}

TEST_CASE("relative reflectance: by hand") {
  // The reference receives 0.5 / 4 of the lamp's intensity, the material 0.8 / 9.
  const auto found = reference_light({2.0, 0.0}, 0.9, {.cosine = 0.5, .distance = 2.0})
                         .brdf({3.0, 0.0}, {.cosine = 0.8, .distance = 3.0});
  CHECK(found.value == doctest::Approx(0.9 / std::numbers::pi * 3.0 / 2.0 * (0.5 / 4.0) / (0.8 / 9.0)));
}

TEST_CASE("relative reflectance: the deviations of both exposures add up") {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  constexpr int repetitions = 20'000;
  const double exact = reference_light({2.0, 0.0}, 0.99).brdf({0.7, 0.0}).value;
  double squares = 0.0, predicted = 0.0;
  for (int i = 0; i < repetitions; ++i) {
    const uncertain reference{2.0 + 0.04 * normal(generator), 0.04}, material{0.7 + 0.021 * normal(generator), 0.021};
    const uncertain found = reference_light(reference, 0.99).brdf(material);
    squares += std::pow(found.value - exact, 2) / repetitions;
    predicted += std::pow(found.deviation, 2) / repetitions;
  }
  CHECK(squares / predicted > 0.96);
  CHECK(squares / predicted < 1.04);
}

TEST_CASE("absolute reflectance: f = dL / dE, and the same as by a reference under the same lamp") {
  CHECK(rc::check("a material of any BRDF comes back", [] {
    const auto number = [](int from, int to) { return *rc::gen::inRange(from, to) / 100.0; };
    const double f = number(1, 300), lamp = number(10, 1000), camera = number(10, 1000);
    const double solid_angle = number(1, 600), transmittance = number(1, 101);
    const illumination at{number(5, 101), number(50, 200)};
    // A lamp of radiance L at the distance d: E = L Omega cos(theta_i) / d^2, where Omega is the solid angle at
    // distance 1.
    const double irradiance = lamp * solid_angle * at.cosine / (at.distance * at.distance);
    const uncertain material{camera * f * irradiance, 0.0};
    const auto found =
        reference_light::of_lamp({transmittance * camera * lamp, 0.0}, solid_angle, transmittance).brdf(material, at);
    RC_ASSERT(std::abs(found.value / f - 1.0) < 1e-12);
    const uncertain white{camera * std::numbers::inv_pi * irradiance, 0.0};
    RC_ASSERT(std::abs(found.value / reference_light(white, 1.0, at).brdf(material, at).value - 1.0) < 1e-12);
  }));
  const auto found = reference_light::of_lamp({2.0, 0.06}, 0.01).brdf({3.0, 0.12});
  CHECK(found.value == doctest::Approx(150.0));
  CHECK(found.relative_deviation() == doctest::Approx(0.05));
}

TEST_CASE("relative reflectance: Eq. 13 and 17 agree") {
  const double omega = gonio::capture::pixel_solid_angle(25.0, 4.0, 350.0), cosine = 0.6;
  const uncertain f = reference_light({3.0, 0.0}, 1.0).brdf({1.2, 0.0});
  CHECK(gonio::capture::reflectance_into(f.value, omega, cosine) ==
        doctest::Approx(1.2 / 3.0 * omega * cosine / std::numbers::pi));
}

TEST_CASE("weights fall with the square of the deviation") {
  CHECK(gonio::capture::weight_of(0.0) == 1.0);
  CHECK(gonio::capture::weight_of(0.01) == doctest::Approx(1.0).epsilon(2e-4));
  CHECK(gonio::capture::weight_of(0.1) == doctest::Approx(1.0 / 1.01));
  CHECK(gonio::capture::weight_of(2.0) == doctest::Approx(0.2));
  CHECK(gonio::capture::weight_of(0.1, 0.05) == doctest::Approx(0.2));
  CHECK(gonio::capture::weight_of(std::numeric_limits<double>::infinity()) == 0.0);
  CHECK(gonio::capture::weight_of(std::nan("")) == 0.0);  // 0 +- 0
}

TEST_CASE("relative reflectance: bad input is refused") {
  using doctest::Contains;
  const auto make = [](const uncertain& exposure, double rho, const illumination& at) {
    return reference_light(exposure, rho, at);
  };
  CHECK_THROWS_WITH_AS(make({0.0, 0.0}, 0.99, {}), Contains("exposure must be positive"), gonio::error);
  CHECK_THROWS_WITH_AS(make({1.0, -1.0}, 0.99, {}), Contains("deviation"), gonio::error);
  CHECK_THROWS_WITH_AS(make({1.0, 0.0}, 1.01, {}), Contains("up to 1, not 1.01"), gonio::error);
  CHECK_THROWS_WITH_AS(make({1.0, 0.0}, 0.99, {.cosine = 0.0}), Contains("cosine"), gonio::error);
  CHECK_THROWS_WITH_AS(make({1.0, 0.0}, 0.99, {.distance = std::nan("")}), Contains("distance"), gonio::error);
  CHECK_THROWS_WITH_AS(reference_light::of_lamp({0.0, 0.0}, 0.1), Contains("lamp's exposure must be positive"),
                       gonio::error);
  CHECK_THROWS_WITH_AS(reference_light::of_lamp({1.0, 0.0}, 0.0), Contains("solid angle"), gonio::error);
  CHECK_THROWS_WITH_AS(reference_light::of_lamp({1.0, 0.0}, 7.0), Contains("solid angle"), gonio::error);
  CHECK_THROWS_WITH_AS(reference_light::of_lamp({1.0, 0.0}, 0.1, 1.1), Contains("transmittance"), gonio::error);
  CHECK_THROWS_WITH_AS(make({1.0, 0.0}, 0.99, {}).brdf({1.0, 0.0}, {.cosine = -0.1}), Contains("cosine"), gonio::error);
}
