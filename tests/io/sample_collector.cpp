#include "scratch.hpp"
#include <gonio/core/spectrum.hpp>
#include <gonio/io/measurements/sample_collector.hpp>

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
  CHECK(spectrum.wavelengths() == std::vector{450.0, 550.0, 650.0});
  CHECK(colour_channels::xyz().wavelengths().empty());
  CHECK(spectrum.have_colour());
  CHECK(colour_channels::spectrum(std::array{1064.0}).have_colour());
  CHECK_FALSE(colour_channels::spectrum(std::array{600.0, 1000.0}).have_colour());
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
  const std::array one{1.0};
  collector.add({up, gonio::spherical_direction(gonio::radians(90.0), 0.0)}, one);
  collector.add({gonio::spherical_direction(gonio::radians(100.0), 0.0), up}, one);
  sample_collector none = collector;
  check_refused([&] { return std::move(none).samples("empty.table"); }, {"empty.table", "no sample above the horizon"});
  collector.add({up, gonio::spherical_direction(gonio::radians(89.9), 0.0)}, one, 0.5);
  const auto samples = std::move(collector).samples("one.table");
  REQUIRE(samples.size() == 1);
  CHECK(samples[0].weight == 0.5);
}

TEST_CASE("spectra are kept beside the colours that they make") {
  const gonio::direction up{0.0, 0.0, 1.0}, aside = gonio::spherical_direction(0.5, 0.0);
  sample_collector collector;
  collector.use_wavelengths(std::array{450.0, 550.0, 650.0});
  collector.add({up, aside}, std::array{0.1, 0.2, 0.4});
  collector.add({aside, up}, std::array{0.2, 0.2, 0.2}, 0.5);
  collector.use_wavelengths(std::array{450.0, 550.0, 650.0});
  const sample_collector both = collector;
  const auto spectra = sample_collector(both).spectra("two.table");
  CHECK(spectra.wavelengths == std::vector{450.0, 550.0, 650.0});
  CHECK(spectra.weights == std::vector{1.0, 0.5});
  CHECK(spectra.values(0, 2) == 0.4f);
  const auto colours = sample_collector(both).samples("two.table");
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(spectra.colours()[i].value.isApprox(colours[i].value, 1e-6));
    CHECK(spectra.directions[i].pair().wi == colours[i].directions.pair().wi);
  }
  // Other wavelengths in the next pair of directions make colours, but no table of spectra.
  collector.use_wavelengths(std::array{450.0, 550.0});
  collector.add({up, up}, std::array{0.1, 0.1});
  CHECK(sample_collector(collector).samples("three.table").size() == 3);
  check_refused([&] { return std::move(collector).spectra("three.table"); },
                {"three.table", "other wavelengths", "the same in all"});
}

TEST_CASE("invisible spectra are spectra, and no colours; colours are no spectra") {
  const gonio::direction up{0.0, 0.0, 1.0};
  sample_collector infrared(colour_channels::spectrum(std::array{600.0, 1000.0}));
  infrared.add({up, up}, std::array{0.1, 0.2});
  CHECK(sample_collector(infrared).spectra("ir.table").values(0, 1) == 0.2f);
  check_refused([&] { return std::move(infrared).samples("ir.table"); }, {"ir.table", "fewer than two", "visible"});
  sample_collector rgb(colour_channels::linear_rgb());
  rgb.add({up, up}, std::array{0.1, 0.2, 0.3});
  check_refused([&] { return std::move(rgb).spectra("rgb.table"); }, {"rgb.table", "no spectra"});
}

TEST_CASE("what no float holds is refused") {
  const gonio::io::text_place place{"large.table", 7};
  gonio::io::detail::require_float_range(-3e38, place);
  check_refused(
      [&] {
        gonio::io::detail::require_float_range(1e39, place);
        return 0;
      },
      {"large.table", "line 7", "1e+39", "range of float"});
}
