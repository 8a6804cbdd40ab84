#include <gonio/capture/camera_response.hpp>
#include <gonio/capture/device.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <array>
#include <functional>
#include <random>

using gonio::capture::camera_response;
using gonio::capture::estimate_response;
using gonio::capture::exposure_counts;

namespace {

/// The count, as a fraction of the largest, for an exposure from 0 to 1.
using curve = std::function<double(double)>;

double linear(double exposure) { return exposure; }
double gamma_curve(double exposure) { return std::pow(exposure, 1.0 / 2.2); }
/// A response with a toe and a shoulder on a logarithmic scale.
double s_shaped(double exposure) { return 1.25 * std::pow(exposure, 1.2) / (std::pow(exposure, 1.2) + 0.25); }

/// Simulates a camera of this response: counts of pixels of many radiances, with relative noise.
exposure_counts expose(const curve& response, std::uint16_t largest, double noise, int pixels, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> log_radiance(std::log(0.02), std::log(60.0));
  exposure_counts counts(pixels, std::ssize(gonio::capture::note_exposure_times));
  for (Eigen::Index i = 0; i < counts.rows(); ++i) {
    const double radiance = std::exp(log_radiance(generator));
    for (Eigen::Index j = 0; j < counts.cols(); ++j) {
      const double exposure = radiance * gonio::capture::note_exposure_times[j] * (1.0 + noise * normal(generator));
      counts(i, j) = static_cast<std::uint16_t>(std::lround(largest * response(std::clamp(exposure, 0.0, 1.0))));
    }
  }
  return counts;
}

/// Returns the largest relative error of the exposure over counts from `from` to 0.98 of the largest. Exposures are
/// relative to the middle count's.
double worst_error(const camera_response& found, const curve& response, double from) {
  const auto exposure_of = [&](double share) {  // by bisection
    double low = 0.0, high = 1.0;
    for (int step = 0; step < 60; ++step) {
      const double middle = (low + high) / 2.0;
      (response(middle) < share ? low : high) = middle;
    }
    return high;
  };
  double worst = 0.0;
  for (double share = from; share <= 0.98; share += 1.0 / 256.0)
    worst = std::max(
        worst, std::abs(found.exposure(share * found.largest_count()) * exposure_of(0.5) / exposure_of(share) - 1.0));
  return worst;
}

}  // namespace

TEST_CASE("camera response: within 1 % for linear, gamma 2.2 and S-shaped cameras, with 1 % noise") {
  for (const unsigned seed : {1u, 2u, 3u})
    for (const curve& response : {curve(linear), curve(gamma_curve), curve(s_shaped)})
      for (const std::uint16_t largest : {std::uint16_t(255), std::uint16_t(4095), std::uint16_t(65535)}) {
        const auto found = estimate_response(expose(response, largest, 0.01, 2000, seed),
                                             gonio::capture::note_exposure_times, largest);
        // Below 13 of 255 counts, rounding to integers exceeds the noise.
        CHECK(worst_error(found, response, largest == 255 ? 0.05 : 0.02) < 0.01);
      }
}

TEST_CASE("camera response: exact without noise, for every power law") {
  CHECK(rc::check("a power law is found again", [] {
    const double exponent = *rc::gen::inRange(3, 30) / 10.0;
    const auto counts = expose([&](double x) { return std::pow(x, 1.0 / exponent); }, 65535, 0.0, 200, 5);
    const auto found = estimate_response(counts, gonio::capture::note_exposure_times, 65535);
    const auto expected = camera_response::power_law(65535, exponent);
    for (const double share : {0.05, 0.2, 0.4, 0.8, 0.95})
      RC_ASSERT(std::abs(found.log_exposure(share * 65535) - expected.log_exposure(share * 65535)) < 2e-3);
  }));
}

TEST_CASE("camera response: it never falls, whatever the counts") {
  CHECK(rc::check("no value is below the one before", [] {
    std::mt19937_64 generator(*rc::gen::arbitrary<unsigned>());
    exposure_counts counts(30, 5);
    for (Eigen::Index i = 0; i < counts.size(); ++i)
      counts.data()[i] = static_cast<std::uint16_t>(std::uniform_int_distribution<int>(1, 254)(generator));
    const auto found = estimate_response(counts, gonio::capture::note_exposure_times, 255);
    for (Eigen::Index k = 1; k < found.log_exposures().size(); ++k)
      RC_ASSERT(found.log_exposures()[k] >= found.log_exposures()[k - 1]);
  }));
}

TEST_CASE("camera response: counts and exposures are inverse, slopes are derivatives") {
  const auto camera = camera_response::power_law(1023, 2.2);
  CHECK(camera.exposure(1023 / 2.0) == doctest::Approx(1.0));
  CHECK(camera.exposure(0.0) == 0.0);
  CHECK(camera.count(0.0) == 0.0);
  CHECK(camera.count(100.0) == 1023.0);
  for (const double count : {0.5, 3.0, 17.2, 400.0, 1022.0}) {
    CHECK(camera.log_exposure(count) == doctest::Approx(2.2 * std::log(count / 511.5)));
    CHECK(camera.count(camera.exposure(count)) == doctest::Approx(count));
    CHECK(camera.slope(count) == doctest::Approx(2.2 / count));
  }
}

TEST_CASE("camera response: bad input is refused") {
  using doctest::Contains;
  const exposure_counts counts = exposure_counts::Constant(3, 2, 100);
  const std::vector two{0.1, 0.2}, three{0.1, 0.2, 0.4}, negative{0.1, -0.2};
  CHECK_THROWS_WITH_AS(estimate_response(counts, three, 255), Contains("not 3 times and 2 columns"), gonio::error);
  CHECK_THROWS_WITH_AS(estimate_response(counts, negative, 255), Contains("must be positive"), gonio::error);
  CHECK_THROWS_WITH_AS(estimate_response(counts, two, 99), Contains("count is 100"), gonio::error);
  CHECK_THROWS_WITH_AS(estimate_response(counts, two, 2), Contains("a camera of 2 counts"), gonio::error);
  CHECK_THROWS_WITH_AS(estimate_response(exposure_counts::Zero(3, 2), two, 255), Contains("neither dark nor"),
                       gonio::error);
  CHECK_THROWS_WITH_AS(estimate_response(exposure_counts(0, 2), two, 255), Contains("neither dark nor"), gonio::error);
  CHECK_THROWS_WITH_AS(camera_response(255, Eigen::VectorXd{{0.0, 1.0, 0.5}}), Contains("falls from value 2"),
                       gonio::error);
  CHECK_THROWS_WITH_AS(camera_response(255, Eigen::VectorXd{{0.0}}), Contains("at least two"), gonio::error);
  CHECK_THROWS_WITH_AS(camera_response(2, Eigen::VectorXd{{0.0, 1.0, 2.0}}), Contains("of 3 values"), gonio::error);
  CHECK_THROWS_WITH_AS(camera_response(255, Eigen::VectorXd{{0.0, std::nan("")}}), Contains("finite"), gonio::error);
}
