#include <gonio/core/error.hpp>
#include <gonio/table/sample_set.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <ranges>

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

TEST_CASE("what no estimator can use is refused with the sample's number") {
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
  refused({{0.1, 0.2, 0.3}, rgb(1, 1, -1e39), 1.0}, "beyond the range of float");
  refused({{0.1, 0.2, 0.3}, rgb::Ones(), -1.0}, "weight");
  refused({{0.1, 0.2, 0.3}, rgb::Ones(), inf}, "weight");
  refused({{1.0, 1.2, 0.0}, rgb::Ones(), 1.0}, "horizon");
  refused({{0.1, -0.2, 0.0}, rgb::Ones(), 1.0}, "horizon");
  refused({{6.9, 0.2, 0.0}, rgb::Ones(), 1.0}, "horizon");  // 400 degrees, whose cosines look innocent
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
