#include "../synthetic_materials.hpp"
#include <gonio/estimate/highlight_contrast.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <limits>

using gonio::highlight_contrast;
using gonio::highlight_regions;

namespace {

/// Regions suited to a grid of few cells.
constexpr highlight_regions wide{0.15, 0.5};

const gonio::log_relative& contrast_reference() {
  static const auto metric = gonio::log_relative::to_median_of(synthetic_materials(small_cells(), 9));
  return metric;
}

/// A grey table with mapped luminance `in_peak` up to 0.15, `off_peak` from 0.5 on, and arbitrary values between.
gonio::brdf_table grey_table(double in_peak, double off_peak, const gonio::valid_cells& cells = small_cells()) {
  gonio::brdf_table table(cells);
  for (Eigen::Index cell = 0; cell < cells.size(); ++cell) {
    const auto angles = cells.angles(cell);
    const double mapped = angles.theta_h <= 0.15 ? in_peak : angles.theta_h < 0.5 ? 17.0 : off_peak;
    const double rho = contrast_reference().inverse(mapped, gonio::locate(small_cells(), angles));
    table.set(cell, gonio::rgb::Constant(rho));
  }
  return table;
}

gonio::sample_set every_cell(const gonio::brdf_table& table) {
  gonio::sample_set samples;
  for (Eigen::Index cell = 0; cell < table.cells().size(); ++cell)
    samples.push_back({table.cells().angles(cell), table.at(cell), 1.0});
  return samples;
}

}  // namespace

TEST_CASE("the contrast is the difference of the mapped luminances, on any cells") {
  CHECK(highlight_contrast(contrast_reference(), grey_table(1.5, 0.25), wide) == doctest::Approx(1.25).epsilon(1e-5));
  CHECK(highlight_contrast(contrast_reference(), grey_table(0.25, 0.25), wide) == doctest::Approx(0.0).epsilon(1e-5));
  const gonio::valid_cells others(gonio::grid({14, 6, 8}));
  CHECK(highlight_contrast(contrast_reference(), grey_table(0.5, 1.0, others), wide) ==
        doctest::Approx(-0.5).epsilon(1e-5));
}

TEST_CASE("the reference itself has no contrast, and an unshiny material less than a shiny one") {
  gonio::brdf_table reference(small_cells()), flat(small_cells());
  for (Eigen::Index cell = 0; cell < small_cells().size(); ++cell) {
    reference.set(cell, gonio::rgb::Constant(double{contrast_reference().reference()[cell]}));
    flat.set(cell, gonio::rgb(0.1, 0.2, 0.3));
  }
  CHECK(std::abs(highlight_contrast(contrast_reference(), reference, wide)) < 1e-6);
  CHECK(highlight_contrast(contrast_reference(), flat, wide) < -1.0);
}

TEST_CASE("samples at all cells have the table's contrast, and that of a set's material") {
  const auto set = synthetic_materials(small_cells(), 4, 99);
  const auto all = gonio::highlight_contrasts(contrast_reference(), set, wide);
  REQUIRE(all.size() == 4);
  for (std::size_t m = 0; m < 4; ++m) {
    const auto table = set.table(m);
    const double one = highlight_contrast(contrast_reference(), table, wide);
    CHECK(all[m] == doctest::Approx(one).epsilon(1e-12));
    CHECK(highlight_contrast(contrast_reference(), every_cell(table), wide).value() ==
          doctest::Approx(one).epsilon(1e-6));
  }
  const auto threaded = gonio::highlight_contrasts(contrast_reference(), set, wide, {3});
  CHECK((threaded == gonio::highlight_contrasts(contrast_reference(), set, wide, {1})).all());
}

TEST_CASE("property: weights average the mapped luminances, and samples between the regions do not matter") {
  CHECK(rc::check("weighted means", [] {
    const auto table = grey_table(*rc::gen::inRange(-2, 3) / 2.0, *rc::gen::inRange(-2, 3) / 2.0);
    auto samples = every_cell(table);
    const double doubled = *rc::gen::inRange(1, 9) / 2.0;
    double mapped = 0.0, weights = 0.0;
    for (auto& s : samples) {
      s.weight = *rc::gen::inRange(0, 4);
      const bool between = s.angles().theta_h > wide.in_peak && s.angles().theta_h < wide.off_peak;
      if (between) s.value *= doubled;
      if (s.angles().theta_h > wide.in_peak) continue;
      mapped += s.weight.mean() * contrast_reference().forward(s.value.x(), gonio::locate(small_cells(), s.angles()));
      weights += s.weight.mean();
    }
    samples.push_back({{0.7, 0.1, 0.2}, gonio::rgb::Constant(0.2), 1.0});
    const auto found = highlight_contrast(contrast_reference(), samples, wide);
    RC_ASSERT(found.has_value() == (weights > 0.0));
    if (!found) return;
    const double in_peak = mapped / weights;
    for (auto& s : samples) s.weight = 2.0 * s.weight.mean();
    RC_ASSERT(std::abs(*highlight_contrast(contrast_reference(), samples, wide) - *found) < 1e-9);
    for (auto& s : samples)
      if (s.angles().theta_h > wide.in_peak) s.weight = 0.0;
    RC_ASSERT(!highlight_contrast(contrast_reference(), samples, wide));
    const auto [i, o] = gonio::to_directions({0.7, 0.1, 0.2});
    const auto at = gonio::locate(small_cells(), gonio::to_half_difference(i, o));
    samples.back().weight = 1.0;
    RC_ASSERT(std::abs(*highlight_contrast(contrast_reference(), samples, wide) - in_peak +
                       contrast_reference().forward(0.2, at)) < 1e-9);
  }));
}

TEST_CASE("samples in one region only say nothing, unusable ones are refused") {
  gonio::sample_set samples{{{0.01, 0.3, 0.2}, gonio::rgb(1, 1, 1), 1.0}, {{0.2, 0.3, 0.2}, gonio::rgb(1, 1, 1), 1.0}};
  CHECK_FALSE(highlight_contrast(contrast_reference(), samples));  // 0.57 and 11 degrees
  samples[1].directions = gonio::half_difference{0.4, samples[1].angles().theta_d, samples[1].angles().phi_d};
  CHECK(highlight_contrast(contrast_reference(), samples));
  samples[1].weight = 0.0;
  CHECK_FALSE(highlight_contrast(contrast_reference(), samples));
  samples[0].value.y() = std::nan("");
  CHECK_THROWS_WITH_AS((void)highlight_contrast(contrast_reference(), samples), doctest::Contains("sample 1"),
                       gonio::error);
  CHECK_THROWS_AS((void)highlight_contrast(contrast_reference(), gonio::sample_set{}), gonio::error);
}

TEST_CASE("zeros and negative measurements have a finite contrast") {
  const gonio::sample_set samples{{{0.01, 0.3, 0.2}, gonio::rgb(0, 0, 0), 1.0},
                                  {{0.6, 0.3, 0.2}, gonio::rgb(-1, -1, -1), 1.0}};
  CHECK(std::isfinite(highlight_contrast(contrast_reference(), samples).value()));
}

TEST_CASE("a set is split at the median, or where it is said") {
  const auto set = synthetic_materials(small_cells(), 9);
  const auto contrasts = gonio::highlight_contrasts(contrast_reference(), set, wide);
  const auto halves = gonio::split_by_contrast(set, contrast_reference(), {}, wide);
  CHECK(halves.soft.names.size() == 4);
  CHECK(halves.specular.names.size() == 5);
  for (const auto& name : halves.soft.names) CHECK(contrasts[set.find(name)] < halves.threshold);
  for (const auto& name : halves.specular.names) {
    const std::size_t m = set.find(name);
    CHECK(contrasts[m] >= halves.threshold);
    CHECK(std::ranges::equal(halves.specular.table(halves.specular.find(name)).values(), set.table(m).values()));
  }
  const auto one = gonio::split_by_contrast(set, contrast_reference(), contrasts.maxCoeff(), wide);
  CHECK(one.soft.names.size() == 8);
  CHECK(one.threshold == contrasts.maxCoeff());
}

TEST_CASE("sets that cannot be split are refused") {
  auto set = synthetic_materials(small_cells(), 3);
  const auto split = [&](std::optional<double> threshold, const highlight_regions& regions = wide) {
    return gonio::split_by_contrast(set, contrast_reference(), threshold, regions);
  };
  CHECK_THROWS_WITH_AS((void)split(1e3), doctest::Contains("all 3 materials are soft"), gonio::error);
  CHECK_THROWS_WITH_AS((void)split(-1e3), doctest::Contains("all 3 materials are specular"), gonio::error);
  CHECK_THROWS_WITH_AS((void)split(std::nan("")), doctest::Contains("specular"), gonio::error);
  CHECK_THROWS_WITH_AS((void)split(0.0, {1e-4, 0.5}), doctest::Contains("too coarse"), gonio::error);
  set.values(0, 4) = std::numeric_limits<float>::quiet_NaN();
  CHECK_THROWS_WITH_AS((void)split({}), doctest::Contains("'material-1'"), gonio::error);
  set.names.pop_back();
  CHECK_THROWS_AS((void)split({}), gonio::error);
}
