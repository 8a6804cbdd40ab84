#include <gonio/capture/dark_signal.hpp>
#include <gonio/core/error.hpp>

#include <doctest/doctest.h>

#include <limits>

using gonio::capture::dark_signal;
using gonio::capture::exposed_frame;

namespace {

/// Returns a row of pixels that count 100 plus 10 per second. The last pixel is hot in green.
exposed_frame dark_row(double seconds, std::size_t pixels = 50) {
  exposed_frame frame{seconds, {1, pixels, 4095, std::vector<std::uint16_t>(3 * pixels)}};
  for (auto& count : frame.codes.values) count = static_cast<std::uint16_t>(100 + 10 * seconds);
  frame.codes.values[3 * pixels - 2] = static_cast<std::uint16_t>(100 + 500 * seconds);
  return frame;
}

}  // namespace

TEST_CASE("dark signal: a line through dark frames gives the counts at all times") {
  const std::vector frames{dark_row(1.0), dark_row(1.0), dark_row(4.0), dark_row(4.0)};
  const dark_signal dark(frames);
  CHECK(dark.size() == 150);
  CHECK(dark.level() == doctest::Approx(100.0));
  CHECK(dark.count(0, 2.5) == doctest::Approx(125.0));
  CHECK(dark.count(148, 2.0) == doctest::Approx(1100.0));
  CHECK(dark.hot_pixels() == std::vector<Eigen::Index>{49});
  // The variance with four frames, at the middle exposure and at an end: 1/4 and 1/4 + 1.5^2 / (4 * 1.5^2).
  CHECK(dark.relative_variance(2.5) == doctest::Approx(0.25));
  CHECK(dark.relative_variance(4.0) == doctest::Approx(0.5));
  dark.require_known(100.0);
}

TEST_CASE("dark signal: the first pixel may be hot, in any channel") {
  for (std::size_t channel = 0; channel < 3; ++channel) {
    std::vector frames{dark_row(1.0), dark_row(4.0)};
    for (exposed_frame& frame : frames) frame.codes.values[channel] = static_cast<std::uint16_t>(500 * frame.seconds);
    CHECK(dark_signal(frames).hot_pixels() == std::vector<Eigen::Index>{0, 49});
  }
}

TEST_CASE("dark signal: frames of one exposure time determine no other time") {
  const std::vector frames{dark_row(2.0), dark_row(2.0)};
  const dark_signal dark(frames);
  CHECK(dark.count(0, 2.0) == doctest::Approx(120.0));
  CHECK(dark.level() == doctest::Approx(120.0));
  CHECK(dark.relative_variance(2.0) == doctest::Approx(0.5));
  dark.require_known(2.01);
  CHECK_THROWS_WITH_AS(dark.require_known(1.0), doctest::Contains("two exposure times"), gonio::error);
}

TEST_CASE("dark signal: without frames it is a level") {
  const dark_signal none, level(64.0);
  CHECK((none.count(7, 3.0) == 0.0 && level.count(7, 3.0) == 64.0));
  CHECK((none.relative_variance(3.0) == 0.0 && none.size() == 0 && none.hot_pixels().empty()));
  level.require_known(1e6);
}

TEST_CASE("dark signal: frames that differ are refused") {
  using doctest::Contains;
  const auto refuses = [](std::vector<exposed_frame> frames, const char* words) {
    CHECK_THROWS_WITH_AS(dark_signal{frames}, Contains(words), gonio::error);
  };
  refuses({}, "no frame");
  refuses({dark_row(1.0), dark_row(1.0, 4)}, "4 x 1 pixels, but the first has 50 x 1");
  exposed_frame deeper = dark_row(1.0), cut = dark_row(1.0);
  deeper.codes.largest = 65535;
  cut.codes.values.pop_back();
  refuses({dark_row(1.0), deeper}, "counts up to 65535");
  refuses({cut}, "has 149 counts");
  for (const double time :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    refuses({dark_row(1.0), {time, dark_row(1.0).codes}}, "positive and finite");
}
