#include <gonio/capture/device.hpp>
#include <gonio/capture/high_dynamic_range.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <random>

using gonio::capture::camera_response;
using gonio::capture::measured_radiance;
using gonio::capture::merge_exposures;
using gonio::capture::sensor_noise;

namespace {

/// Simulates a camera with a power-law response: the counts of a radiance at the note's exposure times.
std::vector<std::uint16_t> expose(double radiance, double gamma, double largest, const sensor_noise& noise,
                                  std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  std::vector<std::uint16_t> counts;
  for (const double time : gonio::capture::note_exposure_times) {
    const double exposure = radiance * time * (1.0 + noise.relative * normal(generator));
    const double exact = largest / 2.0 * std::pow(exposure, 1.0 / gamma);
    const double noisy = exact + std::sqrt(noise.read * noise.read + noise.shot * exact) * normal(generator);
    counts.push_back(static_cast<std::uint16_t>(std::clamp(std::round(noisy), 0.0, largest)));
  }
  return counts;
}

constexpr sensor_noise none{0.0, 0.0, 0.0};

}  // namespace

TEST_CASE("high dynamic range: without noise the radiance of four decades comes back") {
  CHECK(rc::check("what was exposed is merged, to the rounding of counts", [] {
    const double gamma = *rc::gen::inRange(10, 25) / 10.0;
    const auto camera = camera_response::power_law(65535, gamma);
    const double radiance = std::exp(*rc::gen::inRange(-200, 400) / 100.0);
    std::mt19937_64 generator(0);
    const auto merged = merge_exposures(expose(radiance, gamma, 65535, none, generator),
                                        gonio::capture::note_exposure_times, camera, none);
    RC_ASSERT(merged.usable());
    RC_ASSERT(std::abs(merged.value / radiance - 1.0) < 1e-3);
  }));
}

TEST_CASE("high dynamic range: the stated deviation is the actual one") {
  const auto camera = camera_response::power_law(4095);
  const sensor_noise noise{2.0, 0.5, 0.01};
  std::mt19937_64 generator(3);
  for (const double radiance : {0.1, 1.0, 10.0, 100.0}) {
    constexpr int repetitions = 4000;
    double bias = 0.0, squares = 0.0, within = 0.0;
    for (int i = 0; i < repetitions; ++i) {
      const auto merged = merge_exposures(expose(radiance, 1.0, 4095, noise, generator),
                                          gonio::capture::note_exposure_times, camera, noise, 4000);
      const double off = (merged.value - radiance) / merged.deviation;
      bias += off / repetitions;
      squares += off * off / repetitions;
      within += (std::abs(off) < 1.96 ? 1.0 : 0.0) / repetitions;
    }
    INFO("radiance " << radiance << ": bias " << bias << ", mean square " << squares << ", within " << within);
    CHECK(std::abs(bias) < 0.1);
    CHECK(squares > 0.85);
    CHECK(squares < 1.15);
    CHECK(within > 0.93);
    CHECK(within < 0.97);
  }
}

TEST_CASE("high dynamic range: dark and saturated pixels are distinguished") {
  const auto camera = camera_response::power_law(255);
  const std::vector<std::uint16_t> dark(5, 0), bright(5, 255), both{0, 0, 255, 255, 255};
  const measured_radiance black = merge_exposures(dark, gonio::capture::note_exposure_times, camera);
  CHECK((black.dark && !black.saturated && !black.usable()));
  CHECK(black.value == 0.0);
  CHECK(black.deviation == doctest::Approx(camera.exposure(1.0) / 0.2));
  const measured_radiance white = merge_exposures(bright, gonio::capture::note_exposure_times, camera);
  CHECK((white.saturated && !white.dark && !white.usable()));
  CHECK(white.value == doctest::Approx(camera.exposure(255.0) / 0.0125));
  CHECK(std::isinf(white.deviation));
  CHECK(merge_exposures(both, gonio::capture::note_exposure_times, camera).saturated);
  // A limit below the largest count also bounds the usable counts.
  const std::vector<std::uint16_t> nearly(5, 251);
  CHECK(merge_exposures(nearly, gonio::capture::note_exposure_times, camera).usable());
  CHECK(merge_exposures(nearly, gonio::capture::note_exposure_times, camera, {}, 250).saturated);
}

TEST_CASE("high dynamic range: bad input is refused") {
  using doctest::Contains;
  const auto camera = camera_response::power_law(255);
  const std::vector<std::uint16_t> counts{1, 2};
  const std::vector one{0.1}, zero{0.1, 0.0}, two{0.1, 0.2};
  CHECK_THROWS_WITH_AS(merge_exposures(counts, one, camera), Contains("2 counts"), gonio::error);
  CHECK_THROWS_WITH_AS(merge_exposures({}, {}, camera), Contains("at least one"), gonio::error);
  CHECK_THROWS_WITH_AS(merge_exposures(counts, zero, camera), Contains("must be positive"), gonio::error);
  CHECK_THROWS_WITH_AS(merge_exposures(counts, two, camera, {-1.0, 0.0, 0.0}), Contains("not negative"), gonio::error);
}
