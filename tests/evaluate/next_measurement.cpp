#include "../synthetic_materials.hpp"
#include <gonio/evaluate/next_measurement.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>

#include <doctest/doctest.h>

#include <array>

namespace {

const gonio::measurement_chooser<gonio::log_relative>& small_chooser() {
  static const gonio::measurement_chooser chooser{
      gonio::reconstruction{learn(synthetic_materials(small_cells(), 12), 10)}, {}, small_cells()};
  return chooser;
}

gonio::sample_set three_samples(unsigned material) {
  const auto table = synthetic_materials(small_cells(), 1, material).table(0);
  return gonio::sample_table(table, std::vector<Eigen::Index>{5, 90, 210});
}

}  // namespace

TEST_CASE("each further measurement leaves less, none is made twice, and one is the first of many") {
  const auto chosen = small_chooser().choose(three_samples(99), 5);
  REQUIRE(chosen.size() == 5);
  for (std::size_t i = 1; i < chosen.size(); ++i) {
    CHECK(chosen[i].expected_delta_e <= chosen[i - 1].expected_delta_e);
    for (std::size_t j = 0; j < i; ++j)
      CHECK(gonio::angle_between(chosen[i].pose.wi, chosen[j].pose.wi) +
                gonio::angle_between(chosen[i].pose.wo, chosen[j].pose.wo) >
            1e-3);
  }
  const auto first = small_chooser().choose(three_samples(99), 1).front();
  CHECK(first.expected_delta_e == chosen.front().expected_delta_e);
  CHECK(first.angles.theta_h == chosen.front().angles.theta_h);
}

TEST_CASE("the choice depends on what was read; with nothing read there is one, too") {
  bool differs = false;
  const auto usual = small_chooser().choose(three_samples(1), 3);
  for (const unsigned material : {2u, 3u, 4u, 5u}) {
    const auto other = small_chooser().choose(three_samples(material), 3);
    for (std::size_t i = 0; i < 3; ++i) differs |= other[i].angles.theta_h != usual[i].angles.theta_h;
  }
  CHECK(differs);
  CHECK(small_chooser().choose({}, 2).size() == 2);
}

TEST_CASE("one value is chosen for as a grey, and wavelengths by their colour") {
  const gonio::channels bands({300.0, 350.0, 450.0, 550.0, 650.0});
  gonio::sample_set grey, value{gonio::channels::one_value()}, spectra{bands}, others{bands};
  for (const gonio::sample& s : three_samples(99)) {
    const double g = s.value.y();
    grey.push_back({s.directions, gonio::rgb::Constant(g)});
    value.add(s.directions, std::array{g});
    // The first two wavelengths are invisible.
    spectra.add(s.directions, std::array{0.9 * g, 1.1 * g, g, g, g});
    others.add(s.directions, std::array{3.0 * g, 0.2 * g, g, g, g});
  }
  const auto expected = small_chooser().choose(grey, 4), of_value = small_chooser().choose(value, 4),
             of_spectra = small_chooser().choose(spectra, 4), of_others = small_chooser().choose(others, 4),
             of_colours = small_chooser().choose(spectra.in_three_channels(), 4);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(of_value[i].pose.wi == expected[i].pose.wi);
    CHECK(of_value[i].pose.wo == expected[i].pose.wo);
    CHECK(of_value[i].expected_delta_e == doctest::Approx(expected[i].expected_delta_e));
    for (const auto& same : {of_others[i], of_colours[i]}) {
      CHECK(of_spectra[i].pose.wi == same.pose.wi);
      CHECK(of_spectra[i].pose.wo == same.pose.wo);
    }
  }
}

TEST_CASE("measuring makes the stated deviation smaller") {
  gonio::sample_set samples = three_samples(99);
  const auto known_to = [](const gonio::sample_set& some) {
    return small_chooser().candidates().estimator().fit(some).certainty().known_to;
  };
  const double before = known_to(samples);
  const auto table = synthetic_materials(small_cells(), 1, 99).table(0);
  for (const gonio::sample& more : gonio::sample_table(table, std::vector<Eigen::Index>{30, 60, 120, 150, 180, 240}))
    samples.push_back(more);
  CHECK(before > 0.0);
  CHECK(known_to(samples) < before);
}

TEST_CASE("in the plane of incidence all that is chosen lies in it; a rule that leaves nothing is named") {
  const gonio::reconstruction estimator{learn(synthetic_materials(small_cells(), 12), 10)};
  gonio::design::apparatus with;
  gonio::design::capture_constraint& constraint = with.constraint;
  constraint.plane_tolerance = gonio::radians(0.5);
  const gonio::measurement_chooser in_plane{estimator, with, small_cells()};
  for (const auto& next : in_plane.choose(three_samples(99), 4))
    CHECK(std::abs(next.pose.wi.x() * next.pose.wo.y() - next.pose.wi.y() * next.pose.wo.x()) < 1e-9);
  constraint.light = {gonio::radians(45), gonio::radians(45)};
  CHECK_THROWS_WITH_AS(static_cast<void>(gonio::measurement_chooser{estimator, with, small_cells()}),
                       doctest::Contains("the rule 'light'"), gonio::error);
  CHECK_THROWS_AS(static_cast<void>(small_chooser().choose(three_samples(99), 100000)), gonio::error);
}
