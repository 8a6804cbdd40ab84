#include "scratch.hpp"
#include <gonio/io/measurements/sample_collector.hpp>

#include <array>
#include <limits>
#include <utility>
#include <vector>

using gonio::io::detail::are_new_azimuths;
using gonio::io::detail::sample_collector;
using scratch::check_refused;

TEST_CASE("azimuths that differ by a turn are the same") {
  CHECK(are_new_azimuths(std::array{0.0, 90.0, 360.0, -270.0, -1e-9, 450.0, 91.0}) ==
        std::vector<bool>{true, true, false, false, false, false, true});
  CHECK(are_new_azimuths({}).empty());
}

TEST_CASE("directions at or below the horizon are skipped") {
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

TEST_CASE("values keep their channels, and CIE XYZ becomes a colour") {
  const gonio::direction up{0.0, 0.0, 1.0}, aside = gonio::spherical_direction(0.5, 0.0);
  const std::array values{0.1, 0.2, 0.4};
  sample_collector rgb{gonio::channels()}, xyz = sample_collector::of_xyz(), grey;
  rgb.add({up, aside}, values);
  xyz.add({up, aside}, values);
  CHECK(grey.channel_count() == 1);
  CHECK((std::move(rgb).samples("x")[0].value == gonio::rgb(0.1, 0.2, 0.4)).all());
  CHECK(std::move(xyz).samples("x")[0].value.isApprox(gonio::from_xyz({0.1, 0.2, 0.4}), 1e-14));
  sample_collector spectral;
  spectral.use_wavelengths(std::array{450.0, 550.0, 650.0});
  spectral.add({up, aside}, values);
  spectral.use_wavelengths(std::array{450.0, 550.0, 650.0});
  spectral.add({aside, up}, std::array{0.2, 0.2, 0.2}, 0.5);
  const auto spectra = std::move(spectral).samples("two.table");
  CHECK(spectra.channels() == gonio::channels({450.0, 550.0, 650.0}));
  REQUIRE(spectra.size() == 2);
  CHECK(spectra.values(0)[2] == 0.4);
  CHECK(spectra.weight(1) == gonio::channel_weights(0.5));
  check_refused([] { return sample_collector(gonio::channels({650.0, 450.0})); }, {"wavelength 2"});
}

TEST_CASE("if wavelengths differ between pairs of directions, samples become colours or are refused") {
  const gonio::direction up{0.0, 0.0, 1.0}, aside = gonio::spherical_direction(0.5, 0.0);
  const std::array three{0.1, 0.2, 0.4};
  const std::array two{0.1, 0.1};
  sample_collector collector;
  collector.use_wavelengths(std::array{450.0, 550.0, 650.0});
  collector.add({up, aside}, three);
  sample_collector unseen = collector;
  collector.use_wavelengths(std::array{450.0, 550.0});
  collector.add({up, up}, two);
  const auto colours = std::move(collector).samples("two.table");
  CHECK(colours.channels().are_colours());
  REQUIRE(colours.size() == 2);
  CHECK((colours[0].value == gonio::channels({450.0, 550.0, 650.0}).colour(three)).all());
  CHECK((colours[1].value == gonio::channels({450.0, 550.0}).colour(two)).all());
  unseen.use_wavelengths(std::array{905.0, 1550.0});
  unseen.add({up, up}, two);
  check_refused([&] { return std::move(unseen).samples("ir.table"); },
                {"ir.table", "different wavelengths", "the same wavelengths in"});
}

TEST_CASE("values outside the range of float are refused") {
  const gonio::io::text_position position{"large.table", 7};
  gonio::io::detail::require_float_range(-3e38, position);
  check_refused(
      [&] {
        gonio::io::detail::require_float_range(1e39, position);
        return 0;
      },
      {"large.table", "line 7", "1e+39", "range of float"});
}
