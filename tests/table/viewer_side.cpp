#include <gonio/table/viewer_side.hpp>

#include <doctest/doctest.h>

#include <array>
#include <vector>

using gonio::brightness_towards_light, gonio::sample_set;

namespace {

struct reading {
  double theta_i, theta_o, phi_o, value;
};

sample_set samples_of(const std::vector<reading>& readings) {
  sample_set samples;
  for (const auto& [theta_i, theta_o, phi_o, value] : readings)
    samples.push_back(
        {gonio::direction_pair{gonio::spherical_direction(gonio::radians(theta_i), 0.5),
                               gonio::spherical_direction(gonio::radians(theta_o), 0.5 + gonio::radians(phi_o))},
         gonio::rgb::Constant(value)});
  return samples;
}

}  // namespace

TEST_CASE("the light's side is compared with the mirror direction, or with the other side where that is missing") {
  CHECK(brightness_towards_light(samples_of({{30, 28, 0, 6}, {30, 31, 180, 2}, {30, 60, 180, 9}})) == 3.0);
  CHECK(brightness_towards_light(samples_of({{30, 28, 0, 6}, {30, 60, 180, 3}})) == 2.0);
  // A viewer at the normal is not counted as on the light's side.
  CHECK(brightness_towards_light(samples_of({{30, 28, 0, 6}, {30, 0, 0, 3}})) == 2.0);
  // The median over incidences. A dark side counts as a thousandth of the brightest.
  CHECK(brightness_towards_light(samples_of(
            {{30, 30, 0, 6}, {30, 30, 180, 2}, {40, 40, 0, 9}, {40, 40, 180, 1}, {50, 50, 0, 1}, {50, 50, 180, 0}})) ==
        9.0);
}

TEST_CASE("samples that say nothing of a side do not count") {
  CHECK(brightness_towards_light({}) == 0.0);
  CHECK(brightness_towards_light(samples_of({{5, 5, 0, 6}, {5, 5, 180, 2}})) == 0.0);       // nearly along the normal
  CHECK(brightness_towards_light(samples_of({{30, 30, 20, 6}, {30, 30, 180, 2}})) == 0.0);  // out of plane
  CHECK(brightness_towards_light(samples_of({{30, 50, 0, 6}, {30, 30, 180, 2}})) == 0.0);   // far from the light
}

TEST_CASE("viewers are turned about the normal, and measured values stay") {
  sample_set scan(gonio::channels({450.0, 550.0}));
  const gonio::direction_pair pair{gonio::spherical_direction(0.5, 0.2), gonio::spherical_direction(0.7, 1.0)};
  scan.add(pair, std::array{0.1, 0.2}, 0.5, {0.01, 0.02});
  const sample_set turned = gonio::with_viewers_turned(scan);
  const auto& [wi, wo] = turned.directions(0).pair();
  CHECK(wi == pair.wi);
  CHECK((wo - gonio::direction(-pair.wo.x(), -pair.wo.y(), pair.wo.z())).norm() == 0.0);
  CHECK(turned.values(0)[1] == 0.2);
  CHECK(turned.weight(0) == 0.5);
  CHECK(turned.aperture(0) == gonio::aperture{0.01, 0.02});
  CHECK(turned.channels().wavelengths() == scan.channels().wavelengths());
  const sample_set again = gonio::with_viewers_turned(turned);
  CHECK(again.directions(0).pair().wo == pair.wo);
}
