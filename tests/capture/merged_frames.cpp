#include "lab/photographs.hpp"
#include <gonio/capture/merged_frames.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using gonio::capture::camera_response;
using gonio::capture::exposed_frame;
using gonio::capture::merge_frames;
using gonio::capture::merged_frames;
using gonio::capture::value_state;

namespace {

const std::vector<double> bracket_times{0.001, 0.004, 0.016, 0.064, 0.256};

/// Radiance over five decades, from left to right.
gonio::image ramp(std::size_t rows, std::size_t columns) {
  gonio::image scene = gonio::uniform_image(rows, columns);
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      const double share = static_cast<double>(column) / static_cast<double>(columns);
      gonio::set_pixel(scene, row, column, gonio::rgb(1.0, 0.7, 0.4) * std::pow(10.0, 5.0 * share - 3.5));
    }
  return scene;
}

std::array<camera_response, 3> same_responses(const camera_response& each) { return {each, each, each}; }

/// The merged bracket of the ramp, and the true radiance in the same unit.
struct merged_ramp {
  explicit merged_ramp(const lab::photograph_settings& settings, std::uint64_t seed = 1)
      : truth(lab::through_lens(ramp(40, 200), settings)),
        frames(lab::photograph_bracket(ramp(40, 200), bracket_times, settings, seed)) {
    for (float& value : truth) value = static_cast<float>(lab::merged_unit(settings) * double{value});
    const std::array<double, 2> times{bracket_times.front(), bracket_times.back()};
    dark = gonio::capture::dark_signal(lab::photograph_dark(40, 200, times, 4, settings, seed));
    const std::uint16_t largest = settings.chip.largest_count;
    saturation = static_cast<std::uint16_t>(0.98 * largest);
    merged =
        merge_frames(frames, same_responses(camera_response::power_law(gonio::capture::counts_above(largest, dark))),
                     dark, {.noise = lab::noise_of(settings), .saturation = saturation});
  }

  /// Returns the errors of the values in a given state, in units of their deviations.
  [[nodiscard]] std::vector<double> errors(value_state state) const {
    std::vector<double> all;
    for (std::size_t i = 0; i < merged.states.size(); ++i)
      if (merged.states[i] == state)
        all.push_back((merged.radiance.data()[i] - truth.data()[i]) / merged.deviation.data()[i]);
    return all;
  }

  gonio::image truth;
  std::vector<exposed_frame> frames;
  gonio::capture::dark_signal dark;
  std::uint16_t saturation = 0;
  merged_frames merged;
};

double share_within(const std::vector<double>& errors) {
  const auto within = std::ranges::count_if(errors, [](double each) { return std::abs(each) < 1.96; });
  return static_cast<double>(within) / static_cast<double>(errors.size());
}

exposed_frame pixel_of(double seconds, std::uint16_t count, std::uint16_t largest = 4095) {
  return {seconds, {1, 1, largest, {count, count, count}}};
}

}  // namespace

TEST_CASE("merged frames: 95 % intervals hold 92 to 98 % of the values") {
  lab::photograph_settings settings = lab::photograph_settings::usual();
  settings.flicker = 0.0;  // flicker is the same for all pixels of a frame
  const merged_ramp whole(settings);
  const auto usable = whole.errors(value_state::usable), dark = whole.errors(value_state::dark);
  REQUIRE(usable.size() > 15000);
  CHECK(share_within(usable) > 0.92);
  CHECK(share_within(usable) < 0.98);
  double bias = 0.0;
  for (const double each : usable) bias += each / static_cast<double>(usable.size());
  CHECK(std::abs(bias) < 0.05);
  // Deviations half or twice as large fail the test.
  const auto scaled = [&](double factor) {
    std::vector<double> all = usable;
    for (double& each : all) each *= factor;
    return share_within(all);
  };
  CHECK(scaled(2.0) < 0.8);
  CHECK(scaled(0.5) > 0.99);
}

TEST_CASE("merged frames: without noise the radiance comes back") {
  lab::photograph_settings settings;
  settings.vignetting = 0.2;
  const merged_ramp whole(settings);
  CHECK(whole.merged.count(value_state::contradictory) == 0);
  for (std::size_t i = 0; i < whole.merged.states.size(); ++i)
    if (whole.merged.states[i] == value_state::usable)
      REQUIRE(std::abs(whole.merged.radiance.data()[i] / whole.truth.data()[i] - 1.0) < 0.02);
}

TEST_CASE("merged frames: hot pixels are named, and their values not trusted") {
  lab::photograph_settings settings = lab::photograph_settings::usual();
  settings.hot_pixels = 0.002;
  const merged_ramp whole(settings);
  std::vector<Eigen::Index> expected;
  for (Eigen::Index pixel = 0; pixel < 8000; ++pixel)
    if (lab::detail::current_of_pixel(settings, pixel) == settings.hot_current) expected.push_back(pixel);
  REQUIRE(expected.size() > 5);
  CHECK(whole.dark.hot_pixels() == expected);
  for (const Eigen::Index pixel : expected) {
    CHECK(whole.merged.pixel_state(pixel) >= value_state::hot);
    CHECK(std::isinf(whole.merged.deviation.data()[3 * pixel]));
  }
}

TEST_CASE("merged frames: a pixel has the worst state of its channels") {
  merged_frames frames;
  frames.states.assign(12, value_state::usable);
  frames.states[1] = value_state::saturated;
  frames.states[3] = frames.states[8] = value_state::dark;
  CHECK(frames.pixel_state(0) == value_state::saturated);
  CHECK(frames.pixel_state(1) == value_state::dark);
  CHECK(frames.pixel_state(2) == value_state::dark);
  CHECK(frames.pixel_state(3) == value_state::usable);
  CHECK(frames.count(value_state::dark) == 2);
}

TEST_CASE("merged frames: the noise of the dark frames adds to the noise of the photograph") {
  // The mean of two dark frames has half the variance of one: read noise and rounding to integers.
  const std::vector dark_frames{pixel_of(0.5, 0), pixel_of(0.5, 0)};
  const std::vector photograph{pixel_of(0.5, 1000)};
  const auto responses = same_responses(camera_response::power_law(4095));
  for (const double read : {0.0, 2.0}) {
    const auto deviation = [&](const gonio::capture::dark_signal& dark) {
      return double{merge_frames(photograph, responses, dark, {.noise = {.read = read, .shot = 0.0, .relative = 0.0}})
                        .deviation(0, 0, 0)};
    };
    CHECK(deviation(gonio::capture::dark_signal(dark_frames)) / deviation({}) ==
          doctest::Approx(std::sqrt(1.5)).epsilon(1e-3));
  }
}

TEST_CASE("merged frames: the response is estimated from the frames") {
  lab::photograph_settings settings;
  settings.chip = lab::sensor::usual(lab::response_curve::gamma);
  const auto frames = lab::photograph_bracket(ramp(40, 200), bracket_times, settings, 3);
  const auto found = gonio::capture::estimate_responses(frames);
  const auto known = camera_response::power_law(4095, 2.2);
  for (const camera_response& each : found)
    for (const double count : {400.0, 1000.0, 3000.0, 3800.0})
      CHECK(each.exposure(count) == doctest::Approx(known.exposure(count)).epsilon(0.005));
}

TEST_CASE("merged frames: with an estimated response, too, 95 % intervals hold 92 to 98 % of the values") {
  for (const lab::response_curve curve :
       {lab::response_curve::linear, lab::response_curve::gamma, lab::response_curve::s_shaped}) {
    lab::photograph_settings settings;
    settings.chip = lab::sensor::usual(curve);
    settings.flicker = 0.001;
    const gonio::image scene = ramp(100, 400);
    const auto frames = lab::photograph_bracket(scene, bracket_times, settings, 3);
    const auto merged =
        merge_frames(frames, gonio::capture::estimate_responses(frames), {}, {.noise = lab::noise_of(settings)});
    const double unit = lab::merged_unit(settings);
    std::vector<double> errors;
    for (std::size_t i = 0; i < merged.states.size(); ++i)
      if (merged.states[i] == value_state::usable)
        errors.push_back((merged.radiance.data()[i] - unit * scene.data()[i]) / merged.deviation.data()[i]);
    CAPTURE(static_cast<int>(curve));
    CHECK(share_within(errors) > 0.92);
    CHECK(share_within(errors) < 0.98);
  }
}

TEST_CASE("merged frames: the same bytes for any number of threads") {
  const auto frames = lab::photograph_bracket(ramp(100, 200), bracket_times, lab::photograph_settings::usual(), 1);
  const auto responses = same_responses(camera_response::power_law(4095));
  const auto one = merge_frames(frames, responses, {}, {.threads = {1}});
  const auto three = merge_frames(frames, responses, {}, {.threads = {3}});
  CHECK(one.radiance == three.radiance);
  CHECK(one.deviation == three.deviation);
  CHECK(one.states == three.states);
}

TEST_CASE("merged frames: dark, saturated and contradictory values are distinguished") {
  const auto responses = same_responses(camera_response::power_law(4095));
  // Two pixels: the first is the one tested, the second is always usable.
  const auto merged = [&](std::vector<std::uint16_t> counts) {
    std::vector<exposed_frame> frames;
    double seconds = 0.01;
    for (const std::uint16_t count : counts) {
      frames.push_back({seconds, {1, 2, 4095, {count, count, count, 500, 500, 500}}});
      seconds *= 2.0;
    }
    return merge_frames(frames, responses, {}, {.noise = {.read = 1.0, .shot = 0.1, .relative = 0.1}});
  };
  CHECK(merged({500, 1000}).states[0] == value_state::usable);
  CHECK(merged({500, 4095}).states[0] == value_state::usable);
  CHECK(merged({100, 3000}).states[0] == value_state::contradictory);
  const auto black = merged({0, 0}), white = merged({4095, 4095}), both = merged({0, 4095});
  CHECK((black.states[0] == value_state::dark && black.radiance(0, 0, 0) == 0.0f && black.deviation(0, 0, 0) > 0.0f));
  CHECK((white.states[0] == value_state::saturated && std::isinf(white.deviation(0, 0, 0))));
  CHECK(white.radiance(0, 0, 0) == doctest::Approx(2.0 / 0.01));  // a lower bound, not black
  CHECK(both.states[0] == value_state::saturated);
  CHECK(white.count(value_state::saturated) == 1);
}

TEST_CASE("merged frames: bad input is refused") {
  using doctest::Contains;
  const auto responses = same_responses(camera_response::power_law(4095));
  const auto refuses = [&](const std::vector<exposed_frame>& frames, const char* words,
                           const gonio::capture::dark_signal& dark = {},
                           const gonio::capture::merge_options& options = {}) {
    CHECK_THROWS_WITH_AS(merge_frames(frames, responses, dark, options), Contains(words), gonio::error);
  };
  const std::vector good{pixel_of(0.1, 7), pixel_of(0.2, 14)};
  refuses({}, "no frame");
  refuses({pixel_of(0.1, 7), {0.2, {1, 2, 4095, std::vector<std::uint16_t>(6)}}}, "2 x 1 pixels");
  refuses({pixel_of(0.0, 7)}, "positive and finite");
  refuses({pixel_of(0.1, 7, 255)}, "a response of 4095 counts does not fit a camera with 255");
  refuses({pixel_of(0.1, 4095), pixel_of(0.2, 4095)}, "shorter exposures");
  refuses(good, "not negative", {}, {.noise = {.read = std::numeric_limits<double>::quiet_NaN()}});
  refuses(good, "the saturation count is 5000", {}, {.saturation = 5000});
  const std::vector dark_of_two{exposed_frame{0.1, {1, 2, 4095, std::vector<std::uint16_t>(6)}}};
  refuses(good, "dark frames have 2 pixels, photographs 1", gonio::capture::dark_signal(dark_of_two));
  const std::vector dark_of_one{pixel_of(0.1, 0)};
  refuses(good, "two exposure times", gonio::capture::dark_signal(dark_of_one));
}
