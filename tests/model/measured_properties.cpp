#include <gonio/model/lambert.hpp>
#include <gonio/model/measured_properties.hpp>
#include <gonio/model/ward.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

using gonio::direction;
using gonio::rgb;
using gonio::sample_set;
using gonio::spherical_direction;
using gonio::model::compare_equal_samples;
using gonio::model::largest_tail_rise;
using gonio::model::summarise;

namespace {

gonio::brdf_table grey_table() {
  return gonio::tabulate(gonio::model::lambertian{.albedo = {0.2, 0.4, 0.8}},
                         gonio::valid_cells(gonio::grid({20, 15, 18})));
}

gonio::direction_pair any_pair(std::mt19937_64& generator) {
  std::uniform_real_distribution<double> uniform;
  const auto any = [&] {
    const double theta = 1.5 * uniform(generator);
    return spherical_direction(theta, 2.0 * std::numbers::pi * uniform(generator));
  };
  const direction wi = any();
  return {wi, any()};
}

gonio::direction_pair pair_of(const direction& wi, const direction& wo) { return {wi, wo}; }

gonio::direction_pair turned(const gonio::direction_pair& pair, double angle) {
  return {gonio::turned_about_normal(pair.wi, angle), gonio::turned_about_normal(pair.wo, angle)};
}

}  // namespace

TEST_CASE("a table's values, and where it is negative") {
  gonio::brdf_table table = grey_table();
  CHECK(summarise(table).negative_cells == 0);
  CHECK(summarise(table).mean.y() == doctest::Approx(0.4 * std::numbers::inv_pi));
  table.set(17, rgb(0.1, -0.2, 0.1));
  table.set(400, rgb(-0.1, -0.1, 3.0));
  const auto values = summarise(table);
  CHECK(values.negative_cells == 2);
  CHECK(values.lowest_cell == 17);
  CHECK((values.minimum - rgb(-0.1, -0.2, 0.8 * std::numbers::inv_pi).min(0.1)).abs().maxCoeff() < 1e-6);
  CHECK(values.maximum.z() == 3.0);
}

TEST_CASE("a lobe and a constant fall off; a second lobe is a rise, where it is") {
  CHECK(largest_tail_rise(grey_table()).amount < 1e-6);
  const gonio::valid_cells cells(gonio::grid({45, 30, 36}));
  const auto lobe = gonio::tabulate(gonio::model::ward_duer(rgb::Ones(), {.roughness = 0.1}), cells);
  // At a fixed theta_d, the lobe's cosines rise slightly.
  CHECK(largest_tail_rise(lobe).amount < 0.5);

  gonio::brdf_table ringed = grey_table();
  const gonio::grid& over = ringed.cells().grid();
  for (Eigen::Index cell = 0; cell < ringed.cells().size(); ++cell) {
    const auto index = over.cell(ringed.cells().linear(cell));
    if (index.theta_h == 12 && index.theta_d == 3) ringed.set(cell, ringed.at(cell) * rgb(1.0, 1.5, 1.0));
    if (index.theta_h == 0) ringed.set(cell, ringed.at(cell) * 2.0);
    // Cells with a sum of angles above 70 degrees do not count.
    if (index.theta_h == 18) ringed.set(cell, ringed.at(cell) * 9.0);
  }
  const auto rise = largest_tail_rise(ringed);
  CHECK(rise.amount == doctest::Approx(0.5).epsilon(0.02));
  CHECK(rise.theta_h == doctest::Approx(over.theta_h(12)));
  CHECK(rise.theta_d == doctest::Approx(over.theta_d(3)));
  CHECK(rise.channel == 1);
}

TEST_CASE("of what is dark a rise is none: relative to 0.001 per steradian at least") {
  gonio::brdf_table table(gonio::valid_cells(gonio::grid({20, 15, 18})));
  table.set(table.cells().size() / 4, rgb::Constant(1e-5));
  CHECK(largest_tail_rise(table).amount < 0.01);
}

TEST_CASE("pairs that ought to be equal are found, and by how much they differ") {
  const gonio::direction_pair pair{spherical_direction(0.4, 0.3), spherical_direction(1.0, 2.0)};
  const gonio::direction_pair swapped{pair.wo, pair.wi}, mirrored{pair.wi, spherical_direction(1.0, -1.4)};
  const sample_set samples{
      {pair, rgb(1, 1, 1)},      {turned(pair, 1.0), rgb(1, 0.8, 1)},
      {swapped, rgb(1, 1, 0.5)}, {pair, rgb(0.99, 1, 1)},
      {mirrored, rgb(9, 9, 9)},  {pair_of(spherical_direction(0.1, 0), spherical_direction(1.3, 0)), rgb(5, 5, 5)}};
  const auto found = compare_equal_samples(samples);
  CHECK(found.repeated.pairs == 1);
  CHECK(found.repeated.worst == doctest::Approx(0.01));
  CHECK(found.repeated.first == 0);
  CHECK(found.repeated.second == 3);
  CHECK(found.turned.pairs == 2);  // 1 with 0, and with its repeat
  CHECK(found.turned.worst == doctest::Approx(0.2));
  CHECK(found.turned.first == 0);
  CHECK(found.turned.second == 1);
  CHECK(found.reciprocal.pairs == 3);  // 2 with 0, 1 and 3
  CHECK(found.reciprocal.worst == doctest::Approx(0.5));
  CHECK(found.reciprocal.median == doctest::Approx(0.5));
}

TEST_CASE("near the normal azimuths mean little; elsewhere they do") {
  // The viewer at 1 radian is rotated by 1 radian, the light by another azimuth.
  const auto turned_pairs = [](double theta, double off) {
    const sample_set samples{{pair_of(spherical_direction(theta, 0.0), spherical_direction(1.0, 0.0)), rgb::Ones()},
                             {pair_of(spherical_direction(theta, off), spherical_direction(1.0, 1.0)), rgb::Ones()}};
    return compare_equal_samples(samples).turned.pairs;
  };
  CHECK(turned_pairs(0.0, 3.0) == 1);
  CHECK(turned_pairs(0.005, 0.0) == 1);
  CHECK(turned_pairs(0.1, 0.0) == 0);
  CHECK(turned_pairs(0.1, 1.0) == 1);
  // A fixed lamp, and a viewer rotated by three tolerances, are no evidence.
  const double few = gonio::radians(1.5);
  const sample_set near{{pair_of(spherical_direction(0.2, 0.0), spherical_direction(1.0, 0.0)), rgb::Ones()},
                        {pair_of(spherical_direction(0.2, 0.0), spherical_direction(1.0, few)), rgb::Ones()}};
  CHECK(compare_equal_samples(near).turned.pairs == 0);
  CHECK(compare_equal_samples(near).repeated.pairs == 0);
  // In the plane of incidence the azimuths differ by pi, on both sides of the wrap.
  const sample_set in_plane{
      {pair_of(spherical_direction(0.5, 0.0), spherical_direction(1.0, std::numbers::pi)), rgb::Ones()},
      {pair_of(spherical_direction(1.0, 0.0), spherical_direction(0.5, std::numbers::pi)), rgb::Ones()}};
  CHECK(compare_equal_samples(in_plane).reciprocal.pairs == 1);
}

TEST_CASE("half and difference angles have no azimuths: nothing is turned") {
  sample_set samples{{{0.001, 0.7, 0.3}, rgb::Ones()}, {{0.001, 0.7, 2.0}, rgb::Ones()}};
  CHECK(compare_equal_samples(samples).turned.pairs == 0);
  // With azimuths: a sample elsewhere shows that they are known.
  samples.push_back({pair_of(spherical_direction(0.5, 1.0), spherical_direction(1.0, 1.0)), rgb::Ones()});
  CHECK(compare_equal_samples(samples).turned.pairs == 1);
}

TEST_CASE("a reciprocal isotropic material has no differences, whatever is measured; an anisotropic one has") {
  CHECK(rc::check([] {
    std::mt19937_64 generator(*rc::gen::arbitrary<std::uint64_t>());
    const gonio::model::ward_duer paint(rgb::Ones(), {.roughness = 0.3});
    const auto brushed = gonio::model::anisotropic_ward(rgb::Ones(), {.roughness_x = 0.1, .roughness_y = 0.4});
    sample_set samples, along;
    std::vector<gonio::direction_pair> pairs;
    for (int i = 0; i < 20; ++i) {
      const auto pair = any_pair(generator);
      const auto other = turned(pair, 0.5 + 0.1 * i);
      for (const auto& each : {pair, other, gonio::direction_pair{pair.wo, pair.wi}}) {
        samples.push_back({each, paint(each.wi, each.wo)});
        along.push_back({each, brushed(each.wi, each.wo)});
      }
    }
    const auto found = compare_equal_samples(samples, 1e-4), differing = compare_equal_samples(along, 1e-4);
    RC_ASSERT(found.turned.pairs >= 20);
    RC_ASSERT(found.reciprocal.pairs >= 40);
    RC_ASSERT(found.turned.worst < 1e-9);
    RC_ASSERT(found.reciprocal.worst < 1e-9);
    RC_ASSERT(differing.turned.worst > 0.01);
  }));
}

TEST_CASE("many samples of one pair are compared with a hundred others each") {
  const gonio::direction_pair pair{spherical_direction(0.4, 0.3), spherical_direction(1.0, 2.0)};
  const sample_set samples(1000, gonio::sample{pair, rgb::Ones()});
  const auto found = compare_equal_samples(samples);
  CHECK(found.repeated.pairs == 100 * 900 + 99 * 100 / 2);
  CHECK(found.turned.pairs == 0);
  CHECK(found.reciprocal.pairs == 0);
}

TEST_CASE("what cannot be compared is refused") {
  const sample_set one{{{0.1, 0.2, 0.3}, rgb::Ones()}};
  for (const double wrong : {0.0, -0.1, 0.2, std::numeric_limits<double>::quiet_NaN()})
    CHECK_THROWS_WITH_AS(compare_equal_samples(one, wrong), doctest::Contains("tolerance"), gonio::error);
  CHECK_THROWS_WITH_AS(compare_equal_samples({}), doctest::Contains("no samples"), gonio::error);
  CHECK_THROWS_WITH_AS(compare_equal_samples({{{0.1, 0.2, 0.3}, rgb(1, std::nan(""), 1)}}),
                       doctest::Contains("sample 1"), gonio::error);
}
