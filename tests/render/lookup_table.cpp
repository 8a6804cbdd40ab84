#include <gonio/model/formula_materials.hpp>
#include <gonio/render/lookup_table.hpp>
#include <gonio/render/merl_view.hpp>
#include <gonio/table/brdf_table.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <limits>
#include <random>

using gonio::direction;
using gonio::rgb;
using gonio::render::interpolation;
using gonio::render::lookup_table;
using gonio::render::merl_view;

static_assert(gonio::render::table_over_cells<gonio::brdf_table>);

namespace {

const gonio::grid coarse({45, 30, 60});

const gonio::brdf_table& paint() {
  static const gonio::brdf_table table =
      gonio::tabulate(gonio::model::formula_material("red-paint"), gonio::valid_cells(coarse));
  return table;
}

/// Returns pairs that are uniform above the horizon, except every fourth, which is close to the mirror direction.
std::vector<gonio::direction_pair> some_pairs(std::size_t count) {
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> uniform(1e-3, 1.0);
  const auto any = [&] {
    const double z = uniform(generator);
    return gonio::spherical_direction(std::acos(z), 6.3 * uniform(generator));
  };
  std::vector<gonio::direction_pair> pairs;
  for (std::size_t i = 0; i < count; ++i) {
    const direction wi = any();
    direction wo = any();
    if (i % 4 == 0) wo = gonio::turned({-wi.x(), -wi.y(), wi.z()}, 1e-3 * uniform(generator), 1.0);
    if (wo.z() > 0.0) pairs.push_back({wi, wo});
  }
  return pairs;
}

/// Returns the values of a MERL file, without its header.
std::vector<double> planes_of(const gonio::brdf_table& table) {
  const Eigen::Index plane = table.cells().grid().size();
  std::vector<double> planes(3 * plane, -1.0);
  for (Eigen::Index cell = 0; cell < table.cells().size(); ++cell)
    for (Eigen::Index channel = 0; channel < 3; ++channel)
      planes[channel * plane + table.cells().linear(cell)] =
          table.values()[3 * cell + channel] / gonio::merl_scale[channel];
  return planes;
}

double relative_difference(const rgb& a, const rgb& b) { return ((a - b).abs() / b.abs().max(1e-6)).maxCoeff(); }

}  // namespace

TEST_CASE("lookup table: trilinear look-up is the table's own") {
  for (const auto anchor : {gonio::cell_anchor::centre, gonio::cell_anchor::lower_corner}) {
    const auto table = gonio::tabulate(gonio::model::formula_material("red-paint"),
                                       gonio::valid_cells(gonio::grid({45, 30, 60}, anchor)));
    const auto fast = lookup_table<double>::of(table);
    const auto in_float = lookup_table<float>::of(table);
    double worst = 0.0, worst_in_float = 0.0;
    for (const auto& [wi, wo] : some_pairs(20'000)) {
      const rgb expected = table(wi, wo);
      worst = std::max(worst, relative_difference(fast(wi, wo), expected));
      const Eigen::Vector3f i = wi.cast<float>(), o = wo.cast<float>();
      worst_in_float = std::max(worst_in_float, relative_difference(in_float(i, o).cast<double>(), expected));
    }
    MESSAGE("largest relative difference in double " << worst << ", in float " << worst_in_float);
    CHECK(worst < 1e-7);  // the table itself stores floats
    CHECK(worst_in_float < 1e-3);
  }
}

TEST_CASE("lookup table: nearest look-up is the table's own but at the horizon, which it continues") {
  for (const auto anchor : {gonio::cell_anchor::centre, gonio::cell_anchor::lower_corner}) {
    const auto table = gonio::tabulate(gonio::model::formula_material("red-paint"),
                                       gonio::valid_cells(gonio::grid({45, 30, 60}, anchor)));
    const auto fast = lookup_table<float, interpolation::nearest>::of(table);
    const gonio::nearest_lookup expected(table);
    std::size_t other = 0, continued = 0;
    const auto pairs = some_pairs(20'000);
    for (const auto& [wi, wo] : pairs) {
      const rgb value = expected(wi, wo), found = fast(wi, wo);
      if ((value == 0.0).all()) {
        continued += (found > 0.0).all() ? 1u : 0u;
        continue;
      }
      other += (found == value).all() ? 0u : 1u;
    }
    CHECK(other == 0u);
    CHECK(continued > 0u);
  }
}

TEST_CASE("lookup table: many pairs at once are the pairs one by one") {
  const auto pairs = some_pairs(1'003);  // not a multiple of the block size
  const auto check = [&]<class Real>(const auto& table, Real tolerance, std::size_t allowed) {
    const std::size_t count = pairs.size();
    std::array<std::vector<Real>, 9> arrays;
    for (auto& array : arrays) array.resize(count);
    for (std::size_t i = 0; i < count; ++i)
      for (int k = 0; k < 3; ++k) {
        const std::size_t slot = k;
        arrays[slot][i] = static_cast<Real>(pairs[i].wi[k]);
        arrays[3 + slot][i] = static_cast<Real>(pairs[i].wo[k]);
      }
    arrays[2][5] = Real(-0.5);  // below the horizon, and not finite
    arrays[4][7] = std::numeric_limits<Real>::quiet_NaN();
    table.template evaluate<Real>({arrays[0], arrays[1], arrays[2]}, {arrays[3], arrays[4], arrays[5]},
                                  {arrays[6], arrays[7], arrays[8]});
    std::size_t other = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Matrix<Real, 3, 1> wi(arrays[0][i], arrays[1][i], arrays[2][i]),
          wo(arrays[3][i], arrays[4][i], arrays[5][i]);
      const Eigen::Array<Real, 3, 1> one = table(wi, wo), found(arrays[6][i], arrays[7][i], arrays[8][i]);
      other += ((one - found).abs() <= tolerance * one).all() ? 0u : 1u;
      if (i == 5 || i == 7) CHECK((found == Real(0)).all());
    }
    CHECK(other <= allowed);
  };
  check.operator()<double>(lookup_table<double>::of(paint()), 1e-12, 0);
  check.operator()<float>(lookup_table<float>::of(paint()), 1e-4f, 0);
  check.operator()<double>(lookup_table<double, interpolation::nearest>::of(paint()), 0.0, 0);
  check.operator()<float>(lookup_table<float, interpolation::nearest>::of(paint()), 0.0f,
                          1);  // a neighbour, if on a border
}

TEST_CASE("lookup table: half numbers are good to three digits, whatever the table's largest value") {
  for (const double factor : {1.0, 1e-6, 1e7}) {
    gonio::brdf_table scaled = paint();
    for (float& value : scaled.values()) value *= static_cast<float>(factor);
    const auto half = lookup_table<Eigen::half>::of(scaled);
    const auto whole = lookup_table<float>::of(scaled);
    double worst = 0.0;
    for (const auto& [wi, wo] : some_pairs(3'000))
      worst = std::max(worst, ((half(wi, wo) - whole(wi, wo)).abs() / whole(wi, wo)).maxCoeff());
    CHECK(worst < std::exp2(-11.0) * 1.01);
    CHECK(half.memory() < 0.52 * static_cast<double>(whole.memory()) + 1e5);
  }
}

TEST_CASE("lookup table: planes of a MERL file say where in its cells their values were taken") {
  const auto material = gonio::model::formula_material("gold-metal");
  for (const auto anchor : {gonio::cell_anchor::centre, gonio::cell_anchor::lower_corner}) {
    const gonio::grid cells(coarse.extents(), anchor);
    const auto table = gonio::tabulate(material, gonio::valid_cells(cells));
    const std::vector<double> planes = planes_of(table);
    const auto copied = lookup_table<double>::from_merl(planes, coarse.extents());
    const merl_view<interpolation::trilinear> viewed(planes, coarse.extents());
    CHECK(copied.grid() == cells);
    CHECK(viewed.grid() == cells);
    for (const auto& [wi, wo] : some_pairs(500)) {
      CHECK(relative_difference(copied(wi, wo), table(wi, wo)) < 1e-6);
      CHECK(relative_difference(viewed(wi, wo), table(wi, wo)) < 1e-6);
    }
  }
}

TEST_CASE("lookup table: of a formula, and of the planes of a MERL file") {
  const auto material = gonio::model::formula_material("gold-metal");
  const auto table = gonio::tabulate(material, gonio::valid_cells(coarse));
  const auto from_formula = lookup_table<float>::tabulated(material, coarse);
  std::vector<double> planes = planes_of(table);
  const auto from_planes = lookup_table<float>::from_merl(planes, coarse);
  for (const auto& [wi, wo] : some_pairs(500)) {
    CHECK(relative_difference(from_formula(wi, wo), table(wi, wo)) < 1e-6);
    CHECK(relative_difference(from_planes(wi, wo), table(wi, wo)) < 1e-6);
  }
  // Doubles keep their precision.
  planes[0] = 1500.0 * (1.0 + 1e-12);
  const auto [wi, wo] = gonio::to_directions(coarse.angles({0, 0, 0}));
  CHECK(lookup_table<double, interpolation::nearest>::from_merl(planes, coarse)(wi, wo)[0] ==
        doctest::Approx(1.0 + 1e-12).epsilon(1e-15));
  planes.pop_back();
  CHECK_THROWS_WITH_AS(lookup_table<float>::from_merl(planes, coarse),
                       "a MERL table needs three planes of 81000 values, not 242999 values", gonio::error);
}

TEST_CASE("lookup table: what is no pair above the horizon is black") {
  const auto table = lookup_table<>::of(paint());
  const auto nearest = lookup_table<float, interpolation::nearest>::of(paint());
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const direction up(0.0, 0.0, 1.0);
  for (const direction& bad : {direction(0.6, 0.0, -0.8), direction(1.0, 0.0, 0.0), direction(nan, 0.0, 1.0),
                               direction(0.0, nan, 1.0), direction(0.0, 0.0, nan), direction(infinity, 0.0, 1.0),
                               direction(0.0, 0.0, infinity), direction(0.0, 1e300, 0.5)}) {
    CHECK((table(bad, up) == 0.0).all());
    CHECK((table(up, bad) == 0.0).all());
    CHECK((nearest(bad, up) == 0.0).all());
    CHECK((nearest(up, bad) == 0.0).all());
  }
  CHECK((table(direction(0.0, 1e-30, 1e-30), up) >= 0.0).all());
}

TEST_CASE("lookup table: directions that are not of unit length") {
  const auto table = lookup_table<double>::of(paint());
  CHECK(rc::check("may both be multiplied by the same factor", [&] {
    const auto pairs = some_pairs(64);
    const auto& [wi, wo] = pairs[*rc::gen::inRange<std::size_t>(0, 32)];
    const double factor = std::exp(*rc::gen::inRange(-100, 100) / 20.0);
    RC_ASSERT(relative_difference(table(direction(factor * wi), direction(factor * wo)), table(wi, wo)) < 1e-9);
  }));
}

TEST_CASE("lookup table: negative measurements are black, what is not finite is refused") {
  gonio::brdf_table table = paint();
  table.values()[3] = -1.0f;
  CHECK((lookup_table<float, interpolation::nearest>::of(table)(gonio::to_directions(table.cells().angles(1)).wi,
                                                                gonio::to_directions(table.cells().angles(1)).wo))[0] ==
        0.0);
  table.values()[4] = std::numeric_limits<float>::quiet_NaN();
  CHECK_THROWS_WITH_AS(lookup_table<>::of(table),
                       "a table for rendering is not finite in cell (0, 0, 1) of (theta_h, theta_d, phi_d)",
                       gonio::error);
}

TEST_CASE("lookup table: a grid without cells above the horizon is refused") {
  const auto white = [](const direction&, const direction&) noexcept { return rgb(rgb::Ones()); };
  CHECK_THROWS_WITH_AS(
      lookup_table<>::tabulated(white, gonio::grid({1, 4, 2})),
      "a grid of 1 x 4 x 2 cells has none above the horizon at theta_d number 3, phi_d number 0: it needs more "
      "cells along theta_h",
      gonio::error);
}
