#include "../synthetic_materials.hpp"
#include <gonio/estimate/located_samples.hpp>
#include <gonio/estimate/values_at.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/interpolate/completed_table.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <ranges>

using gonio::locate_samples;
using gonio::rgb;

namespace {

/// A struct as a laboratory might define it.
struct reading {
  double theta_h, value;
};

gonio::sample to_sample(const reading& one) { return {{one.theta_h, 0.2, 0.3}, gonio::rgb::Constant(one.value), 0.5}; }

const gonio::brdf_table& some_table() {
  static const auto table = synthetic_materials(small_cells(), 1).table(0);
  return table;
}

}  // namespace

TEST_CASE("samples are located by their angles, with their values and weights") {
  CHECK(rc::check([] {
    const auto seed = *rc::gen::inRange(0, 1000);
    const bool apart = *rc::gen::arbitrary<bool>();
    const auto count = [] { return static_cast<double>(*rc::gen::inRange(0, 3)); };
    auto samples =
        gonio::sample_table(some_table(), gonio::random_cells(small_cells(), 12, static_cast<std::uint64_t>(seed)));
    for (std::size_t i = 0; i < samples.size(); ++i) {
      samples[i].weight = count();
      if (apart) samples[i].weight = rgb(count(), count(), count());
      if (*rc::gen::arbitrary<bool>()) {
        auto angles = samples[i].angles();
        angles.theta_h *= 0.9;
        samples[i].directions = angles;
      }
      if (*rc::gen::arbitrary<bool>()) samples[i].value.x() = -1.5;
    }
    samples[5].weight = apart ? gonio::channel_weights(rgb(0.0, 0.0, 0.25)) : 0.25;
    const auto found = locate_samples(small_cells(), samples);
    std::size_t next = 0;
    for (const gonio::sample& s : samples) {
      if (!s.weight.counts()) continue;
      RC_ASSERT(next < found.size());
      const auto expected = gonio::locate(small_cells(), s.angles());
      RC_ASSERT(found.locations[next].cell == expected.cell);
      RC_ASSERT(found.locations[next].weight == expected.weight);
      RC_ASSERT((found.values.row(next).transpose().array() == s.value).all());
      for (Eigen::Index c = 0; c < 3; ++c) {
        RC_ASSERT(found.weights_of(c)[next] == s.weight[c]);
        RC_ASSERT(found.channel_weights()(c, next) == static_cast<float>(s.weight[c]));
      }
      ++next;
    }
    RC_ASSERT(next == found.size());
    RC_ASSERT(found.values.rows() == next);
    RC_ASSERT(found.weighs_channels_apart() == apart);
    RC_ASSERT(found.weights.rows() == next);
    RC_ASSERT(found.weights.cols() == (apart ? 3 : 1));
  }));
}

TEST_CASE("a view of a laboratory's own struct is taken in place") {
  const std::vector<reading> readings{{0.1, 1.0}, {0.2, 2.0}};
  const auto found = locate_samples(small_cells(), readings | std::views::transform(to_sample));
  REQUIRE(found.size() == 2);
  CHECK(found.locations[1].angles.theta_h == 0.2);
  CHECK(found.values(1, 2) == 2.0);
  CHECK(found.weights(0, 0) == 0.5);
}

TEST_CASE("a subset has the chosen samples in the order given") {
  const auto all =
      locate_samples(small_cells(), gonio::sample_table(some_table(), gonio::random_cells(small_cells(), 9, 1)));
  const auto some = all.subset({7, 0, 7});
  REQUIRE(some.size() == 3);
  CHECK(some.locations[0].cell == all.locations[7].cell);
  CHECK(some.locations[1].angles.theta_d == all.locations[0].angles.theta_d);
  CHECK(some.values.row(2) == all.values.row(7));
  CHECK(some.weights.size() == 3);
  CHECK(all.subset({}).size() == 0);
}

TEST_CASE("a table is a measurement of weight 1 at each cell") {
  const auto found = locate_samples(small_cells(), some_table(), {3});
  REQUIRE(found.size() == small_cells().size());
  CHECK((found.weights.array() == 1.0).all());
  for (Eigen::Index cell = 0; cell < std::ssize(found); ++cell) {
    REQUIRE(found.locations[cell].count == 1);
    REQUIRE(found.locations[cell].cell[0] == cell);
    REQUIRE(found.values(cell, 1) == some_table().at(cell).y());
  }
  const gonio::valid_cells others(gonio::grid({5, 6, 8}));
  const auto elsewhere = locate_samples(others, some_table());
  REQUIRE(elsewhere.size() == small_cells().size());
  for (Eigen::Index cell = 0; cell < std::ssize(elsewhere); ++cell) {
    const auto expected = gonio::locate(others, small_cells().angles(cell));
    REQUIRE(elsewhere.locations[cell].cell == expected.cell);
    REQUIRE(elsewhere.locations[cell].weight == expected.weight);
  }
}

TEST_CASE("values of an estimate at locations: few are evaluated, many are read from its table") {
  const gonio::completed_table fit(some_table());
  const gonio::valid_cells fine(gonio::grid({24, 18, 24}));
  std::vector<gonio::location> locations;
  for (Eigen::Index cell = 0; cell < std::ssize(fine); ++cell) {
    locations.push_back(gonio::locate_cell(fine, cell));
    if (cell % 5 == 0) {  // and one between cells
      auto angles = fine.angles(cell);
      angles.theta_h *= 0.97;
      locations.push_back(gonio::locate(fine, angles));
    }
  }
  REQUIRE(locations.size() > 6000);
  const auto all = gonio::values_at(fit, fine, locations, {1});
  CHECK((all == gonio::values_at(fit, fine, locations, {3})).all());
  const std::vector<gonio::location> first(locations.begin(), locations.begin() + 100);
  const auto few = gonio::values_at(fit, fine, first);
  REQUIRE(few.cols() == 100);
  for (std::size_t i = 0; i < locations.size(); ++i) {
    const auto [wi, wo] = to_directions(locations[i].angles);
    const gonio::rgb direct = fit(wi, wo);
    for (Eigen::Index c = 0; c < 3; ++c) {
      // Angles are converted to directions and back.
      REQUIRE(double{all(c, i)} == doctest::Approx(direct[c]).epsilon(1e-6));
      if (i < 100) REQUIRE(few(c, i) == static_cast<float>(direct[c]));
    }
  }
}

TEST_CASE("unusable values are refused by the number of the sample or cell") {
  CHECK_THROWS_WITH_AS(locate_samples(small_cells(), gonio::sample_set{}), doctest::Contains("no samples"),
                       gonio::error);
  gonio::sample_set samples{{{0.1, 0.2, 0.3}, gonio::rgb(1, 1, 1), 0.0}, {{0.3, 0.2, 0.3}, gonio::rgb(1, 1, 1), 0.0}};
  CHECK_THROWS_WITH_AS(locate_samples(small_cells(), samples), doctest::Contains("weight zero"), gonio::error);
  samples[1].weight = 1.0;
  CHECK(locate_samples(small_cells(), samples).size() == 1);
  samples[1].value.y() = 1e39;
  CHECK_THROWS_WITH_AS(locate_samples(small_cells(), samples), doctest::Contains("sample 2"), gonio::error);
  samples[1].value.y() = 1e38;
  CHECK(locate_samples(small_cells(), samples).values(0, 1) == 1e38);
  samples[0].value.y() = std::nan("");  // refused even with weight zero
  CHECK_THROWS_WITH_AS(locate_samples(small_cells(), samples), doctest::Contains("sample 1"), gonio::error);
  auto table = some_table();
  table.values()[3 * 7 + 1] = std::nanf("");
  CHECK_THROWS_WITH_AS(locate_samples(small_cells(), table), doctest::Contains("cell 7"), gonio::error);
}
