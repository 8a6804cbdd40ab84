#include <gonio/core/error.hpp>
#include <gonio/table/spectral_samples.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using gonio::spectral_samples;

namespace {

/// Two measurements at three wavelengths.
spectral_samples two() {
  spectral_samples samples{
      {450.0, 550.0, 650.0}, {{0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}}, gonio::cell_matrix(2, 3), {1, 0.5}};
  samples.values << 0.1f, 0.2f, 0.3f, -0.1f, 0.0f, 2.0f;
  return samples;
}

template <class Change>
void check_refused(const char* word, const Change& change) {
  spectral_samples samples = two();
  change(samples);
  CAPTURE(word);
  CHECK_THROWS_WITH_AS(gonio::require_usable(samples), doctest::Contains(word), gonio::error);
}

}  // namespace

TEST_CASE("a wavelength of spectral samples is grey, and their colours are those of the observer") {
  const spectral_samples samples = two();
  gonio::require_usable(samples);
  CHECK(samples.size() == 2);
  CHECK(samples.bands() == 3);
  const auto green = samples.at_wavelength(1);
  CHECK((green[0].value == double{0.2f}).all());
  CHECK(green[1].weight == gonio::channel_weights(0.5));
  CHECK(green[1].angles().theta_d == 0.5);
  for (const auto light : {gonio::illuminant::d65, gonio::illuminant::a}) {
    const auto colours = samples.colours(light);
    const gonio::spectral_colour colour(samples.wavelengths, light);
    REQUIRE(colours.size() == 2);
    for (Eigen::Index i = 0; i < 2; ++i) CHECK((colours[i].value == colour(samples.spectrum(i))).all());
  }
}

TEST_CASE("one wavelength, a laser's, is grey without any observer") {
  spectral_samples laser{{1064.0}, {{0.1, 0.2, 0.3}}, gonio::cell_matrix::Constant(1, 1, 0.25f)};
  gonio::require_usable(laser);
  CHECK((laser.colours().front().value == 0.25).all());
  CHECK(laser.weight(0) == 1.0);
}

TEST_CASE("some of the samples") {
  const std::vector<Eigen::Index> second{1};
  const spectral_samples some = two().subset(second);
  CHECK(some.size() == 1);
  CHECK(some.values == two().values.row(1));
  CHECK(some.weights == std::vector<double>{0.5});
  CHECK(some.wavelengths == two().wavelengths);
}

TEST_CASE("spectral samples that are none are refused") {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  check_refused("wavelength 2", [](auto& s) { s.wavelengths = {550, 450, 650}; });
  check_refused("wavelength 3", [](auto& s) { s.wavelengths = {450, 550, 550}; });
  check_refused("wavelength 1", [](auto& s) { s.wavelengths = {-450, 550, 650}; });
  check_refused("wavelength 1", [&](auto& s) { s.wavelengths[0] = nan; });
  check_refused("wavelength 3", [&](auto& s) { s.wavelengths[2] = infinity; });
  check_refused("at least one wavelength", [](auto& s) { s.wavelengths.clear(); });
  check_refused("2 x 3 values", [](auto& s) { s.wavelengths.pop_back(); });
  check_refused("values", [](auto& s) { s.directions.pop_back(); });
  check_refused("1 weights", [](auto& s) { s.weights.pop_back(); });
  check_refused("no samples", [](auto& s) { s.directions.clear(); });
  check_refused("sample 2: the reflectance at wavelength 3",
                [&](auto& s) { s.values(1, 2) = static_cast<float>(nan); });
  check_refused("sample 2: the weight", [](auto& s) { s.weights[1] = -1.0; });
  check_refused("sample 1: a direction", [](auto& s) { s.directions[0] = {1.5, 1.5, 0.0}; });
}

TEST_CASE("wavelengths that nobody sees have no colour, but three channels") {
  gonio::spectral_samples samples{{905.0, 1100.0, 1300.0, 1550.0}, {}, gonio::cell_matrix(1, 4)};
  samples.directions.push_back(gonio::half_difference{0.1, 0.2, 0.3});
  samples.values << 0.3f, 0.5f, 0.7f, 1.1f;
  CHECK_THROWS_WITH_AS(static_cast<void>(samples.colours()), doctest::Contains("905 to 1550 nm"), gonio::error);
  const gonio::rgb bands = samples.in_three_channels().front().value;
  CHECK(bands[0] == doctest::Approx(0.3));
  CHECK(bands[1] == doctest::Approx(0.5));
  CHECK(bands[2] == doctest::Approx(0.9));
  // A visible wavelength among them makes a colour.
  samples.wavelengths.front() = 550.0;
  CHECK(samples.in_three_channels().front().value.y() == doctest::Approx(samples.colours().front().value.y()));
}
