#include <gonio/evaluate/comparison.hpp>
#include <gonio/metric/log_relative.hpp>
#include <gonio/model/formula_materials.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

using gonio::appearance_metric;
using gonio::brdf_table;
using gonio::comparison;
using gonio::log_relative;
using gonio::rgb;
using gonio::tabulate;
using gonio::valid_cells;
using gonio::model::lambertian;

namespace {

/// The smallest metric. It has no cells of its own.
struct identity_metric {
  double forward(double rho, const auto&) const noexcept { return rho; }
  double inverse(double y, const auto&) const noexcept { return y; }
};
static_assert(gonio::error_metric<identity_metric>);

/// A small grid with many cells below 5 degrees.
const valid_cells& cells() {
  static const valid_cells result(gonio::grid({30, 15, 30}));
  return result;
}

const appearance_metric& appearance() {
  static const appearance_metric result(cells(), 12);
  return result;
}

brdf_table paint() { return tabulate(gonio::model::formula_material("red-paint"), cells()); }

/// Returns a table of change(cell, value) for the values of a table.
template <class Change>
brdf_table changed(const brdf_table& table, Change&& change) {
  brdf_table result(table.cells());
  for (Eigen::Index cell = 0; cell < table.cells().size(); ++cell) result.set(cell, change(cell, table.at(cell)));
  return result;
}

brdf_table scaled(const brdf_table& table, const rgb& factor) {
  return changed(table, [&](std::size_t, const rgb& value) { return rgb(value * factor); });
}

/// A metric with cells, proportional to a reference.
struct shows_reference {
  log_relative metric;
  [[nodiscard]] const valid_cells& cells() const noexcept { return metric.cells(); }
  double forward(double rho, std::size_t cell) const noexcept { return rho * metric.reference()[cell]; }
  double forward(double rho, const gonio::location& at) const noexcept { return rho * metric.reference(at); }
  double inverse(double y, const auto&) const noexcept { return y; }
};
static_assert(gonio::error_metric<shows_reference>);

/// The log-relative metric over some cells, with one reference everywhere.
log_relative constant_reference(const valid_cells& over, float reference) {
  return {over, std::vector<float>(over.size(), reference)};
}

/// The definition of the interpolated percentile, by sorting all values.
double percentile_by_sorting(const brdf_table& table, std::size_t channel, double limit) {
  std::vector<double> values;
  for (Eigen::Index cell = 0; cell < table.cells().size(); ++cell)
    if (table.cells().angles(cell).theta_h < limit && table.cells().angles(cell).theta_d <= gonio::radians(70.0))
      values.push_back(table.at(cell)[channel]);
  std::ranges::sort(values);
  const double position = 0.999 * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const double fraction = position - static_cast<double>(below);
  return values[below] * (1.0 - fraction) + values[std::min(below + 1, values.size() - 1)] * fraction;
}

bool same(const comparison& a, const comparison& b) {
  return (a.mapped_rms == b.mapped_rms).all() && (a.cosine_rms == b.cosine_rms).all() &&
         (a.peak_ratio == b.peak_ratio).all() && a.delta_e_lights == b.delta_e_lights && a.delta_e_env == b.delta_e_env;
}

}  // namespace

TEST_CASE("a table has no error against itself") {
  const brdf_table truth = paint();
  const comparison result = gonio::compare(truth, truth, constant_reference(cells(), 0.1f), appearance());
  CHECK((result.mapped_rms == 0.0).all());
  CHECK((result.cosine_rms == 0.0).all());
  CHECK((result.peak_ratio == 1.0).all());
  CHECK(result.delta_e_lights == 0.0);
  CHECK(result.delta_e_env == 0.0);
}

TEST_CASE("the mapped error of a constant shift in the mapped domain is that shift, for each channel") {
  const brdf_table truth = paint();
  SUBCASE("log-relative") {
    const rgb shift(0.1, 0.25, 0.5);  // positive: values shifted below zero would be clamped
    const log_relative metric = constant_reference(cells(), 0.1f);
    const brdf_table estimate = changed(truth, [&](std::size_t cell, const rgb& value) {
      rgb result;
      for (Eigen::Index c = 0; c < 3; ++c) result[c] = metric.inverse(metric.forward(value[c], cell) + shift[c], cell);
      return result;
    });
    // The slope of forward is below 1 / rho, and both tables are rounded to float: 6e-8 each.
    const comparison result = gonio::compare(estimate, truth, metric, appearance());
    CHECK((result.mapped_rms - shift).abs().maxCoeff() < 1e-6);
    CHECK(result.mapped_rms.mean() == doctest::Approx(0.85 / 3.0).epsilon(1e-5));
  }
  SUBCASE("a metric without cells") {
    const rgb shift(0.1, -0.25, 0.5);
    const brdf_table estimate = changed(truth, [&](std::size_t, const rgb& value) { return rgb(value + shift); });
    const comparison result = gonio::compare(estimate, truth, identity_metric(), appearance());
    CHECK((result.mapped_rms - shift.abs()).abs().maxCoeff() < 1e-6);
  }
}

TEST_CASE("the cosine error weighs a difference by max(cos_i cos_o, 0.001)") {
  const brdf_table truth = paint();
  const rgb size(1e-3, 1.0, 100.0);
  const brdf_table estimate = changed(truth, [&](std::size_t cell, const rgb& value) {
    const auto cosine = gonio::cosines(cells().angles(cell));
    const double weight = std::max(cosine.i * cosine.o, 0.001), sign = cell % 2 == 0 ? 1.0 : -1.0;
    return rgb(value + sign * size / weight);
  });
  const comparison result = gonio::compare(estimate, truth, identity_metric(), appearance());
  // The rounding of value + 1e-3 / weight to float, relative to 1e-3: values reach about 10 in a few cells of the
  // highlight.
  for (Eigen::Index c = 0; c < 3; ++c) CHECK(result.cosine_rms[c] == doctest::Approx(size[c]).epsilon(1e-4));
}

TEST_CASE("appearance differences are the appearance metric's") {
  const brdf_table truth = paint(), estimate = tabulate(lambertian{{0.3, 0.2, 0.1}}, cells());
  const comparison result = gonio::compare(estimate, truth, identity_metric(), appearance());
  CHECK(result.delta_e_lights == appearance().difference(estimate, truth).lights);
  CHECK(result.delta_e_env == appearance().difference(estimate, truth).environment);
  CHECK(result.delta_e_lights != doctest::Approx(result.delta_e_env).epsilon(0.01));
}

TEST_CASE("the peak ratio of a scaled table is its scale") {
  const brdf_table truth = paint();
  const rgb factor(0.25, 1.0, 8.0);  // powers of two: exact in floats
  const comparison result = gonio::compare(scaled(truth, factor), truth, identity_metric(), appearance());
  CHECK(((result.peak_ratio - factor).abs() < 1e-15 * factor).all());
}

TEST_CASE("the highlight's peak is the 99.9th percentile below 5 degrees: one wild cell does not make it") {
  const brdf_table truth = paint();
  for (std::size_t channel = 0; channel < 3; ++channel)
    CHECK(gonio::highlight_peak(truth)[channel] ==
          doctest::Approx(percentile_by_sorting(truth, channel, gonio::radians(5.0))).epsilon(1e-12));

  const brdf_table wild =
      changed(truth, [](std::size_t cell, const rgb& value) { return cell == 100 ? rgb(rgb::Constant(1e6)) : value; });
  CHECK(gonio::highlight_peak(wild).x() == doctest::Approx(gonio::highlight_peak(truth).x()).epsilon(0.05));
  // The ratio detects a lost highlight.
  const brdf_table matte = tabulate(lambertian{{0.42, 0.028, 0.022}}, cells());
  CHECK(gonio::compare(matte, truth, identity_metric(), appearance()).peak_ratio.maxCoeff() < 0.2);
  // Cells at 5 degrees or more do not count.
  const brdf_table elsewhere = changed(truth, [](std::size_t cell, const rgb& value) {
    return cells().angles(cell).theta_h >= gonio::radians(5.0) ? rgb(50.0 * value) : value;
  });
  CHECK((gonio::highlight_peak(elsewhere) == gonio::highlight_peak(truth)).all());
}

TEST_CASE("the grazing rim does not decide the peak: a lost highlight shows") {
  const valid_cells merl;
  const brdf_table truth = tabulate(gonio::model::formula_material("red-paint"), merl);
  const auto scaled_where = [&](bool grazing, double factor) {
    return changed(truth, [&](std::size_t cell, const rgb& value) {
      return (merl.angles(cell).theta_d > gonio::radians(70.0)) == grazing ? rgb(factor * value) : value;
    });
  };
  const rgb peak = gonio::highlight_peak(truth);
  CHECK((gonio::highlight_peak(scaled_where(true, 50.0)) == peak).all());
  CHECK(((gonio::highlight_peak(scaled_where(false, 0.25)) / peak - 0.25).abs() < 1e-6).all());
  CHECK((gonio::highlight_peak(scaled_where(true, 50.0), gonio::radians(90.0)) > 2.0 * peak).all());
}

TEST_CASE("peaks of zero: a ratio of 1 where both are, of infinity where only the truth's is") {
  const brdf_table truth = scaled(paint(), rgb(1.0, 0.0, 0.0));
  const brdf_table estimate = scaled(paint(), rgb(0.0, 0.0, 1.0));
  const comparison result = gonio::compare(estimate, truth, identity_metric(), appearance());
  CHECK(result.peak_ratio.x() == 0.0);
  CHECK(result.peak_ratio.y() == 1.0);
  CHECK(result.peak_ratio.z() == std::numeric_limits<double>::infinity());
  CHECK((gonio::highlight_peak(scaled(paint(), rgb::Constant(-1.0))) == 0.0).all());
}

TEST_CASE("a grid without cells below 5 degrees has its peak at its smallest theta_h") {
  const valid_cells few(gonio::grid({2, 3, 4}));
  REQUIRE(few.angles(0).theta_h > gonio::radians(5.0));
  brdf_table table(few);
  for (Eigen::Index cell = 0; cell < few.size(); ++cell)
    table.set(cell, rgb::Constant(few.angles(cell).theta_h == few.angles(0).theta_h ? 0.5 : 7.0));
  CHECK((gonio::highlight_peak(table) == 0.5).all());
  // A single cell equals its own percentile.
  const valid_cells one(gonio::grid({1, 1, 1}));
  REQUIRE(one.size() == 1);
  CHECK((gonio::highlight_peak(brdf_table(one, {1.0f, 2.0f, 3.0f})) == rgb(1.0, 2.0, 3.0)).all());
}

TEST_CASE("an estimate over another grid is read at the truth's cells") {
  const brdf_table truth = paint();
  const brdf_table coarse =
      tabulate(gonio::model::formula_material("red-paint"), valid_cells(gonio::grid({16, 10, 12})));
  const log_relative metric = constant_reference(cells(), 0.1f);
  const comparison direct = gonio::compare(coarse, truth, metric, appearance());
  CHECK(same(direct, gonio::compare(gonio::resample(coarse, cells()), truth, metric, appearance())));
  CHECK((direct.mapped_rms > 0.0).all());
  CHECK(direct.mapped_rms.maxCoeff() < 1.0);
}

TEST_CASE("a metric over another grid is read between its cells") {
  const brdf_table truth = paint(), estimate = scaled(truth, rgb(0.5, 2.0, 1.5));
  const valid_cells coarse(gonio::grid({8, 6, 10}));
  const comparison here = gonio::compare(estimate, truth, constant_reference(cells(), 0.1f), appearance());
  const comparison there = gonio::compare(estimate, truth, constant_reference(coarse, 0.1f), appearance());
  // The reference cancels in a difference of logarithms. The cosine weight must be from the truth's cell.
  CHECK((here.mapped_rms - there.mapped_rms).abs().maxCoeff() < 1e-12);

  const comparison weighted = gonio::compare(scaled(truth, rgb::Constant(2.0)), truth,
                                             shows_reference{constant_reference(coarse, 3.0f)}, appearance());
  const comparison plain = gonio::compare(scaled(truth, rgb::Constant(2.0)), truth, identity_metric(), appearance());
  CHECK(((weighted.mapped_rms / plain.mapped_rms - 3.0).abs() < 1e-6).all());
}

TEST_CASE("negative values of an estimate count in the errors as the metric says, in appearance as zero") {
  const brdf_table truth = scaled(paint(), rgb::Zero()), estimate = scaled(paint(), rgb::Constant(-1.0));
  const comparison result = gonio::compare(estimate, truth, constant_reference(cells(), 0.1f), appearance());
  CHECK((result.mapped_rms == 0.0).all());  // log_relative clamps them to zero
  CHECK((result.cosine_rms > 0.0).all());
  CHECK(result.delta_e_env == 0.0);
  CHECK((result.peak_ratio == 1.0).all());
}

TEST_CASE(
    "the number of threads does not change a byte of a comparison, and an appearance metric of other cells is "
    "refused") {
  const brdf_table truth = paint(), estimate = tabulate(gonio::model::formula_material("blue-rubber"), cells());
  const log_relative metric = constant_reference(cells(), 0.1f);
  CHECK(same(gonio::compare(estimate, truth, metric, appearance(), {1}),
             gonio::compare(estimate, truth, metric, appearance(), {5})));
  const valid_cells coarse(gonio::grid({8, 6, 10}));
  const brdf_table elsewhere = tabulate(lambertian(), coarse);
  CHECK_THROWS_AS((void)gonio::compare(truth, elsewhere, metric, appearance()), gonio::error);
}
