#include <gonio/core/spectrum.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <numeric>
#include <vector>

using gonio::rgb;
using gonio::spectral_colour;

namespace {

/// From 400 to 700 nanometres in steps of 10.
std::vector<double> visible() {
  std::vector<double> wavelengths;
  for (int i = 0; i <= 30; ++i) wavelengths.push_back(400.0 + 10.0 * i);
  return wavelengths;
}

/// Reflectance 1 between two wavelengths, 0 outside.
std::vector<double> band(double from, double to) {
  std::vector<double> values;
  for (const double wavelength : visible()) values.push_back(wavelength >= from && wavelength <= to ? 1.0 : 0.0);
  return values;
}

}  // namespace

TEST_CASE("the observer is near the standard's tables") {
  // CIE 1931 2-degree observer, ISO 11664-1.
  struct entry {
    double wavelength;
    rgb expected;
  };
  for (const auto& [wavelength, expected] :
       {entry{450, {0.3362, 0.0380, 1.7721}}, entry{500, {0.0049, 0.3230, 0.2720}}, entry{555, {0.5121, 1.0, 0.0057}},
        entry{600, {1.0622, 0.6310, 0.0008}}, entry{650, {0.2835, 0.1070, 0.0}}}) {
    CAPTURE(wavelength);
    CHECK(((gonio::colour_matching(wavelength) - expected).abs() < 0.03).all());
  }
}

TEST_CASE("daylight: the standard's values and between them") {
  CHECK(gonio::daylight(560) == 100.0);
  CHECK(gonio::daylight(460) == doctest::Approx(117.812));
  CHECK(gonio::daylight(465) == doctest::Approx(0.5 * (117.812 + 114.861)));
  CHECK(gonio::daylight(300) == gonio::daylight(380));
  CHECK(gonio::daylight(900) == gonio::daylight(780));
}

TEST_CASE("observer and daylight together see D65's white") {
  rgb white = rgb::Zero();
  for (double wavelength = 380; wavelength <= 780; wavelength += 1)
    white += gonio::daylight(wavelength) * gonio::colour_matching(wavelength);
  white /= white.y();
  CHECK(white.x() == doctest::Approx(0.95047).epsilon(0.01));
  CHECK(white.z() == doctest::Approx(1.08883).epsilon(0.01));
}

TEST_CASE("grey is grey, whatever the wavelengths") {
  CHECK(rc::check([] {
    const std::size_t count = *rc::gen::inRange(5, 60);
    std::vector<double> wavelengths{380.0};
    while (wavelengths.size() < count)
      wavelengths.push_back(wavelengths.back() +
                            400.0 / static_cast<double>(count) * 0.01 * *rc::gen::inRange(20, 180));
    const double grey = 0.01 * *rc::gen::inRange(-10, 200);
    const spectral_colour colour(wavelengths);
    RC_ASSERT(colour.size() == count);
    const rgb found = colour(std::vector<double>(count, grey));
    RC_ASSERT(((found - grey).abs() <= 1e-6 * std::max(1.0, std::abs(grey))).all());  // the matrices have 7 digits
  }));
}

TEST_CASE("bands are red, green and blue, and add up to white") {
  const spectral_colour colour(visible());
  const rgb blue = colour(band(400, 490)), green = colour(band(500, 580)), red = colour(band(590, 700));
  CHECK(blue.z() > 0.8);
  CHECK(blue.z() > 3.0 * blue.head<2>().maxCoeff());
  CHECK(green.y() > 0.8);
  CHECK(green.y() > 2.0 * std::max(green.x(), green.z()));
  CHECK(red.x() > 0.8);
  CHECK(red.x() > 3.0 * red.tail<2>().maxCoeff());
  CHECK(((blue + green + red - 1.0).abs() < 1e-6).all());
}

TEST_CASE("wavelengths that are no spectrum are refused") {
  const auto refused = [](const std::vector<double>& wavelengths, const char* word) {
    CHECK_THROWS_WITH_AS((void)spectral_colour(wavelengths), doctest::Contains(word), gonio::error);
  };
  refused({}, "two wavelengths");
  refused({500}, "two wavelengths");
  refused({500, 600, 600}, "wavelength 3");
  refused({500, 400}, "wavelength 2");
  refused({std::nan(""), 400}, "wavelength 1");
  refused({400, std::numeric_limits<double>::infinity()}, "wavelength 2");
  refused({20'000, 30'000}, "visible");
}

TEST_CASE("incandescent light: the standard's values") {
  // ISO 11664-2, Table 1: relative power of illuminant A.
  CHECK(gonio::incandescent(380) == doctest::Approx(9.79510).epsilon(1e-5));
  CHECK(gonio::incandescent(460) == doctest::Approx(37.8121).epsilon(1e-5));
  CHECK(gonio::incandescent(560) == doctest::Approx(100.0));
  CHECK(gonio::incandescent(700) == doctest::Approx(198.261).epsilon(1e-5));
  CHECK(gonio::incandescent(780) == doctest::Approx(241.675).epsilon(1e-5));
  CHECK(gonio::relative_power(gonio::illuminant::d65, 460) == gonio::daylight(460));
  CHECK(gonio::relative_power(gonio::illuminant::a, 460) == gonio::incandescent(460));
}

TEST_CASE("observer and incandescent light together see A's white") {
  rgb white = rgb::Zero();
  for (double wavelength = 380; wavelength <= 780; wavelength += 1)
    white += gonio::incandescent(wavelength) * gonio::colour_matching(wavelength);
  white /= white.y();
  CHECK(white.x() == doctest::Approx(1.09850).epsilon(0.01));
  CHECK(white.z() == doctest::Approx(0.35585).epsilon(0.01));
}

TEST_CASE("a spectrum of equal reflectance is white under either light, and a red one is brighter under A") {
  for (const auto light : {gonio::illuminant::d65, gonio::illuminant::a}) {
    const spectral_colour colour(visible(), light);
    const rgb white = colour(std::vector<double>(visible().size(), 1.0));
    CHECK(((white - 1.0).abs() < 1e-6).all());
    CHECK(((colour(std::vector<float>(visible().size(), 1.0f)) - white).abs() < 1e-6).all());
  }
  const spectral_colour daylit(visible()), lamplit(visible(), gonio::illuminant::a);
  const auto red = band(590, 700);
  CHECK(gonio::luminance(lamplit(red)) > 1.2 * gonio::luminance(daylit(red)));
}

TEST_CASE("CIELAB without clipping is that with it inside of the gamut, and tells colours apart outside") {
  for (const rgb& colour : {rgb(1, 1, 1), rgb(0.2, 0.5, 0.9), rgb(0, 0.01, 0.003)})
    CHECK(((gonio::unclipped_lab(colour) - gonio::to_lab(colour)).abs() < 0.01).all());
  CHECK((gonio::unclipped_lab({0.5, -0.1, 0.1}) - gonio::unclipped_lab({0.5, 0.0, 0.1})).abs().maxCoeff() > 1.0);
  CHECK((gonio::to_lab({0.5, -0.1, 0.1}) == gonio::to_lab({0.5, 0.0, 0.1})).all());
}
