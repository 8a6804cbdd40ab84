#include <gonio/core/error.hpp>
#include <gonio/table/sample_set.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <ranges>
#include <vector>

using gonio::rgb;
using gonio::sample;
using gonio::sample_set;

static_assert(gonio::sample_range<sample_set>);

TEST_CASE("usable samples pass, also from a laboratory's own struct") {
  struct reading {
    double theta_h, theta_d, phi_d, r, g, b;
  };
  const std::vector<reading> readings{{0.1, 0.2, 0.3, 1, 2, 3}, {0.0, 1.0, 0.0, -0.1, 0, 0}};
  const auto as_sample = [](const reading& m) {
    return sample{{m.theta_h, m.theta_d, m.phi_d}, rgb(m.r, m.g, m.b), 1.0};
  };
  CHECK_NOTHROW(gonio::require_usable(readings | std::views::transform(as_sample)));
}

TEST_CASE("unusable samples are refused with their number") {
  const sample good{{0.1, 0.2, 0.3}, rgb::Ones(), 1.0};
  const auto refused = [&](const sample& bad, const char* words) {
    CHECK_THROWS_WITH_AS(gonio::require_usable(sample_set{good, bad, good}), doctest::Contains("sample 2"),
                         gonio::error);
    CHECK_THROWS_WITH_AS(gonio::require_usable(sample_set{bad}), doctest::Contains(words), gonio::error);
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  refused({{nan, 0.2, 0.3}, rgb::Ones(), 1.0}, "angle is not finite");
  refused({{0.1, 0.2, inf}, rgb::Ones(), 1.0}, "angle is not finite");
  refused({{0.1, 0.2, 0.3}, rgb(1, nan, 1), 1.0}, "reflectance is not finite");
  refused({{0.1, 0.2, 0.3}, rgb(1, 1, -1e39), 1.0}, "outside the range of float");
  refused({{0.1, 0.2, 0.3}, rgb::Ones(), -1.0}, "weight");
  refused({{0.1, 0.2, 0.3}, rgb::Ones(), inf}, "weight");
  refused({{1.0, 1.2, 0.0}, rgb::Ones(), 1.0}, "horizon");
  refused({{0.1, -0.2, 0.0}, rgb::Ones(), 1.0}, "horizon");
  refused({{6.9, 0.2, 0.0}, rgb::Ones(), 1.0}, "horizon");  // 400 degrees: its cosines look valid
  refused({{0.1, 0.2, 0.3}, rgb::Ones(), 1.0, {gonio::radians(46.0), 0.0}}, "from 0 to 45 degrees");
  refused({{0.1, 0.2, 0.3}, rgb::Ones(), 1.0, {0.0, -0.1}}, "from 0 to 45 degrees");
  CHECK_NOTHROW(gonio::require_usable(
      sample_set{{{0.1, 0.2, 0.3}, rgb::Ones(), 1.0, {gonio::radians(45.0), gonio::radians(45.0)}}}));
  CHECK_THROWS_WITH_AS(gonio::require_usable(sample_set{}), doctest::Contains("no samples"), gonio::error);
}

TEST_CASE("one measurement that counts more in one channel makes all of them count apart") {
  sample_set samples(3, sample{{0.1, 0.2, 0.3}, rgb::Ones(), 0.5});
  CHECK_FALSE(gonio::weigh_channels_apart(samples));
  CHECK_FALSE(gonio::weigh_channels_apart(sample_set{}));
  samples.back().weight = rgb(1.0, 1.0, 0.0);
  CHECK(gonio::weigh_channels_apart(samples));

  struct observation {
    gonio::channel_weights weight;
  };
  CHECK(gonio::weigh_channels_apart(std::vector<observation>{{1.0}, {rgb(1.0, 0.0, 1.0)}}));
}

namespace {

const gonio::channels bands({450.0, 550.0, 650.0, 750.0});

/// Two measurements at four wavelengths.
sample_set two_spectra() {
  sample_set samples(bands);
  samples.add({0.1, 0.2, 0.3}, std::array{0.1, 0.2, 0.3, 0.4});
  samples.add({0.4, 0.5, 0.6}, std::array{-0.1, 0.0, 2.0, 1.0}, 0.5);
  return samples;
}

}  // namespace

TEST_CASE("samples at wavelengths are no colours, and make some") {
  const sample_set samples = two_spectra();
  gonio::require_usable(samples);
  REQUIRE(samples.size() == 2);
  CHECK(samples.values(1)[2] == 2.0);
  CHECK_THROWS_WITH_AS(static_cast<void>(samples[0]), doctest::Contains("4 wavelengths have no colours"), gonio::error);
  CHECK_THROWS_AS(static_cast<void>(samples.begin()), gonio::error);
  CHECK_THROWS_AS(two_spectra().push_back({{0.1, 0.2, 0.3}, rgb::Ones()}), gonio::error);
  for (const auto light : {gonio::illuminant::d65, gonio::illuminant::a}) {
    const sample_set colours = samples.under(light).colours();
    CHECK(colours.channels().are_colours());
    for (std::size_t i = 0; i < 2; ++i)
      CHECK((colours[i].value == bands.under(light).colour(samples.values(static_cast<Eigen::Index>(i)))).all());
    CHECK(colours[1].weight == gonio::channel_weights(0.5));
    CHECK(colours[1].angles().theta_d == 0.5);
  }
}

TEST_CASE("a channel of samples, and some of them") {
  const sample_set samples = two_spectra(), green = samples.channel(1);
  CHECK(green.channels() == gonio::channels({550.0}));
  CHECK((green[0].value == 0.2).all());
  CHECK(green.values(0).size() == 1);
  const std::vector<Eigen::Index> second{1};
  const sample_set some = samples.subset(second);
  REQUIRE(some.size() == 1);
  CHECK(some.channels() == bands);
  CHECK(std::ranges::equal(some.values(0), samples.values(1)));
  CHECK(some.weight(0) == gonio::channel_weights(0.5));
  const sample_set coloured{{{0.1, 0.2, 0.3}, rgb(1, 2, 3)}};
  CHECK(coloured.channel(2).channels() == gonio::channels::one_value());
  CHECK((coloured.channel(2)[0].value == 3.0).all());
  CHECK((coloured.subset(std::vector<Eigen::Index>{0})[0].value == rgb(1, 2, 3)).all());
}

TEST_CASE("unusable samples at wavelengths are refused") {
  const auto refused = [](const char* words, const gonio::sample_directions& at, double value, double weight) {
    sample_set samples = two_spectra();
    samples.add(at, std::array{1.0, value, 1.0, 1.0}, weight);
    CHECK_THROWS_WITH_AS(gonio::require_usable(samples), doctest::Contains(words), gonio::error);
  };
  refused("sample 3: the reflectance at wavelength 2", {0.1, 0.2, 0.3}, std::nan(""), 1.0);
  refused("sample 3: the reflectance at wavelength 2", {0.1, 0.2, 0.3}, 1e39, 1.0);
  refused("sample 3: the weight", {0.1, 0.2, 0.3}, 1.0, -1.0);
  refused("sample 3: a direction", {1.5, 1.5, 0.0}, 1.0, 1.0);
  CHECK_THROWS_WITH_AS(gonio::require_usable(sample_set(bands)), doctest::Contains("no samples"), gonio::error);
  sample_set samples(bands);
  CHECK_THROWS_WITH_AS(samples.add({0.1, 0.2, 0.3}, std::array{1.0}), doctest::Contains("each of 4 channels"),
                       gonio::error);
  CHECK_THROWS_WITH_AS(samples.add({0.1, 0.2, 0.3}, std::array{1.0, 1.0, 1.0, 1.0}, rgb(1, 2, 3)),
                       doctest::Contains("one weight"), gonio::error);
  CHECK(gonio::counting_positions(two_spectra()) == std::vector<Eigen::Index>{0, 1});
}

TEST_CASE("a value is replaced in colours, in one channel, and at a wavelength") {
  const gonio::sample_directions at{0.1, 0.2, 0.3};
  gonio::sample_set colours, grey(gonio::channels({633.0})), spectra(gonio::channels({450.0, 550.0, 650.0}));
  colours.push_back({at, {0.1, 0.2, 0.3}});
  colours.set_value(0, 1, 0.5);
  CHECK((colours[0].value == gonio::rgb(0.1, 0.5, 0.3)).all());
  grey.add(at, std::array{0.1});
  grey.set_value(0, 0, 0.4);
  CHECK((grey[0].value == 0.4).all());
  spectra.add(at, std::array{0.1, 0.2, 0.3});
  spectra.add(at, std::array{0.4, 0.5, 0.6});
  spectra.set_value(1, 2, 0.9);
  CHECK(spectra.values(1)[2] == 0.9);
  CHECK(spectra.values(0)[2] == 0.3);
}
