#include <gonio/core/error.hpp>
#include <gonio/table/channels.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

using gonio::channels;

namespace {

constexpr std::array values{0.1, 0.2, 0.4};

void check_refused(const char* word, const std::vector<double>& wavelengths) {
  CHECK_THROWS_WITH_AS(channels{wavelengths}, doctest::Contains(word), gonio::error);
}

}  // namespace

TEST_CASE("channels are colours by default") {
  CHECK(channels().are_colours());
  CHECK(channels().size() == 3);
  CHECK((channels().colour(values) == gonio::rgb(0.1, 0.2, 0.4)).all());
  CHECK(channels().name(1) == "green");
  CHECK(channels() == channels());
  CHECK_FALSE(channels() == channels({450.0, 550.0, 650.0}));
  CHECK_FALSE(channels({450.0, 550.0, 650.0}).are_colours());
}

TEST_CASE("one value, and one wavelength, are grey without any observer") {
  const channels value = channels::one_value(), laser({1064.5});
  for (const channels& one : {value, laser}) {
    CHECK(one.size() == 1);
    CHECK_FALSE(one.are_wavelengths());
    CHECK(one.have_colour());
    CHECK((one.colour(std::array{0.25}) == 0.25).all());
  }
  CHECK(value.name(0) == "value");
  CHECK(laser.name(0) == "1064.5 nm");
  CHECK_FALSE(value == laser);
}

TEST_CASE("the colours of wavelengths are those of the observer under a light") {
  const std::vector<double> wavelengths{450.0, 550.0, 650.0};
  for (const auto light : {gonio::illuminant::d65, gonio::illuminant::a}) {
    const channels seen = channels(wavelengths).under(light);
    CHECK(seen.light() == light);
    CHECK((seen.colour(values) == gonio::spectral_colour(wavelengths, light)(values)).all());
    CHECK((seen.three(values) == seen.colour(values)).all());
  }
  CHECK(channels(wavelengths).name(2) == "650 nm");
}

TEST_CASE("invisible wavelengths are black, and refused where a colour is needed") {
  const channels unseen({905.0, 1100.0, 1300.0, 1550.0});
  constexpr std::array four{0.3, 0.5, 0.7, 1.1};
  CHECK_FALSE(unseen.have_colour());
  CHECK((unseen.colour(four) == 0.0).all());
  const gonio::rgb bands = unseen.three(four);
  CHECK(bands[0] == doctest::Approx(0.3));
  CHECK(bands[1] == doctest::Approx(0.5));
  CHECK(bands[2] == doctest::Approx(0.9));
  // If there are two channels, each supplies at least one of the three.
  const gonio::rgb of_two = channels({905.0, 1550.0}).three(std::array{0.3, 0.7});
  CHECK((of_two == gonio::rgb(0.3, 0.3, 0.7)).all());
  CHECK_THROWS_WITH_AS(gonio::require_colour(unseen, "ir.csv"), doctest::Contains("ir.csv: its wavelengths, 905 to"),
                       gonio::error);
  gonio::require_colour(channels({550.0, 1100.0}), "half seen");
}

TEST_CASE("invalid wavelengths are refused") {
  check_refused("at least one wavelength", {});
  check_refused("wavelength 2", {550.0, 450.0, 650.0});
  check_refused("wavelength 3", {450.0, 550.0, 550.0});
  check_refused("wavelength 1", {-450.0, 550.0});
  check_refused("wavelength 1", {std::nan(""), 550.0});
  check_refused("wavelength 2", {550.0, std::numeric_limits<double>::infinity()});
}

TEST_CASE("the three numbers of channels have names") {
  using names = std::array<std::string, 3>;
  CHECK(channels().names_of_three() == names{"red", "green", "blue"});
  CHECK(channels({450.0, 550.0, 650.0}).names_of_three() == names{"red", "green", "blue"});
  CHECK(channels({900.0, 1000.0, 1100.0, 1200.0}).names_of_three() == names{"900 nm", "1000 nm", "1100 to 1200 nm"});
  CHECK(channels({905.0, 1550.0}).names_of_three() == names{"905 nm", "905 nm", "1550 nm"});
  CHECK(channels({633.0}).names_of_three() == names{"633 nm", "633 nm", "633 nm"});
}
