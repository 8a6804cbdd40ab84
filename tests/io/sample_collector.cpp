#include "scratch.hpp"
#include <gonio/core/spectrum.hpp>
#include <gonio/io/sample_collector.hpp>

#include <array>
#include <limits>
#include <vector>

using gonio::io::detail::are_new_azimuths;
using gonio::io::detail::colour_channels;
using gonio::io::detail::sample_collector;
using scratch::check_refused;

TEST_CASE("channels: grey, colours as they are, CIE XYZ and spectra") {
  const std::array values{0.1, 0.2, 0.4}, wavelengths{450.0, 550.0, 650.0};
  CHECK(colour_channels::grey().size() == 1);
  CHECK((colour_channels::grey()(values) == 0.1).all());
  CHECK((colour_channels::linear_rgb()(values) == gonio::rgb(0.1, 0.2, 0.4)).all());
  CHECK(colour_channels::xyz()(values).isApprox(gonio::from_xyz({0.1, 0.2, 0.4}), 1e-14));
  const colour_channels spectrum = colour_channels::spectrum(wavelengths);
  CHECK(spectrum.size() == 3);
  CHECK((spectrum(values) == gonio::spectral_colour(wavelengths)(values)).all());
  CHECK((colour_channels::spectrum(std::array{1064.0})(values) == 0.1).all());
  check_refused([] { return colour_channels::spectrum(std::array{600.0, 1000.0}); }, {"fewer than two", "visible"});
  check_refused([] { return colour_channels::spectrum(std::array{650.0, 450.0}); }, {"wavelength 2"});
}

TEST_CASE("azimuths that are a turn apart are the same") {
  CHECK(are_new_azimuths(std::array{0.0, 90.0, 360.0, -270.0, -1e-9, 450.0, 91.0}) ==
        std::vector<bool>{true, true, false, false, false, false, true});
  CHECK(are_new_azimuths({}).empty());
}

TEST_CASE("what is at the horizon or below is no sample") {
  const gonio::direction up{0.0, 0.0, 1.0};
  sample_collector collector;
  collector.add({up, gonio::spherical_direction(gonio::radians(90.0), 0.0)}, gonio::rgb::Ones());
  collector.add({gonio::spherical_direction(gonio::radians(100.0), 0.0), up}, gonio::rgb::Ones());
  sample_collector none = collector;
  check_refused([&] { return std::move(none).take("empty.table"); }, {"empty.table", "no sample above the horizon"});
  collector.add({up, gonio::spherical_direction(gonio::radians(89.9), 0.0)}, gonio::rgb::Ones(), 0.5);
  const auto samples = std::move(collector).take("one.table");
  REQUIRE(samples.size() == 1);
  CHECK(samples[0].weight == 0.5);
}

TEST_CASE("what no float holds is refused") {
  const gonio::io::detail::text_place place{"large.table", 7};
  gonio::io::detail::require_float_range(-3e38, place);
  check_refused(
      [&] {
        gonio::io::detail::require_float_range(1e39, place);
        return 0;
      },
      {"large.table", "line 7", "1e+39", "range of float"});
}
