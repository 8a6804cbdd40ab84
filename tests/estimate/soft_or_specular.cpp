#include "../synthetic_materials.hpp"
#include <gonio/basis/measured.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/estimate/soft_or_specular.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/interpolate/completed_table.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/solve/nnls.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

using gonio::material_kind;
using gonio::soft_or_specular;

namespace {

/// Fits a constant to any samples.
struct always {
  double value;
  gonio::completed_table fit(const gonio::sample_set&) const {
    gonio::brdf_table table(small_cells());
    std::ranges::fill(table.values(), static_cast<float>(value));
    return gonio::completed_table(std::move(table));
  }
};
static_assert(gonio::estimator<soft_or_specular<always, always>>);

using ridge = gonio::decomposition<gonio::log_relative_pca, gonio::tikhonov>;
using linear_combination = gonio::decomposition<gonio::measured<gonio::log>, gonio::nnls>;
static_assert(gonio::estimator<soft_or_specular<ridge, linear_combination>>);
static_assert(gonio::estimator<soft_or_specular<soft_or_specular<always, ridge>, linear_combination>>);

constexpr gonio::highlight_regions few_cells_regions{0.15, 0.5};

const gonio::material_set& shiny_and_not() {
  static const auto set = synthetic_materials(small_cells(), 14);
  return set;
}

const gonio::log_relative& switch_reference() {
  static const auto metric = gonio::log_relative::to_median_of(shiny_and_not());
  return metric;
}

/// Grey samples inside and outside the peak, with a known contrast.
gonio::sample_set samples_of_contrast(double contrast) {
  const auto at = [](double theta_h, double mapped) {
    const gonio::half_difference angles{theta_h, 0.4, 0.7};
    const double rho = switch_reference().inverse(mapped, gonio::locate(small_cells(), angles));
    return gonio::sample{angles, gonio::rgb::Constant(rho), 1.0};
  };
  return {at(0.05, 0.5 + contrast), at(0.9, 0.5)};
}

}  // namespace

TEST_CASE("switch: below the threshold soft, from it on specular") {
  const soft_or_specular estimator{always{1.0}, always{2.0}, switch_reference(), 0.25};
  const auto soft = estimator.fit(samples_of_contrast(0.2)), specular = estimator.fit(samples_of_contrast(0.3));
  CHECK(soft.kind() == material_kind::soft);
  CHECK(specular.kind() == material_kind::specular);
  CHECK(soft.contrast() == doctest::Approx(0.2));
  CHECK(soft({0, 0, 1}, {0, 0, 1}).x() == doctest::Approx(1.0));
  CHECK(specular({0, 0, 1}, {0, 0, 1}).x() == doctest::Approx(2.0));
  CHECK(specular.tabulate(gonio::valid_cells(gonio::grid({5, 6, 7}))).at(9).z() == doctest::Approx(2.0));
  CHECK(soft.chosen().index() == 0);
  CHECK(estimator.threshold() == 0.25);
}

TEST_CASE("property: the fit is that of the estimator chosen, whatever their types") {
  const auto halves = gonio::split_by_contrast(shiny_and_not(), switch_reference(), {}, few_cells_regions);
  const ridge soft{gonio::learn_pca(halves.soft, switch_reference(), 8), gonio::tikhonov{0.1}};
  const linear_combination specular{gonio::measured{halves.specular, gonio::log{}}, gonio::nnls{}};
  const soft_or_specular estimator{soft, specular, switch_reference(), halves.threshold, few_cells_regions};
  CHECK(rc::check("the one or the other", [&] {
    const auto truth = shiny_and_not().table(*rc::gen::inRange<std::size_t>(0, 14));
    const auto samples = gonio::sample_table(truth, gonio::random_cells(small_cells(), 60, *rc::gen::inRange(0u, 99u)));
    const auto fit = estimator.fit(samples);
    RC_ASSERT(fit.kind() == estimator.choose(samples));
    RC_ASSERT((fit.contrast() < estimator.threshold()) == (fit.kind() == material_kind::soft));
    const auto table = fit.tabulate(small_cells(), {1});
    const auto expected = fit.kind() == material_kind::soft ? soft.fit(samples).tabulate(small_cells())
                                                            : specular.fit(samples).tabulate(small_cells());
    RC_ASSERT(std::ranges::equal(table.values(), expected.values()));
    RC_ASSERT(std::ranges::equal(table.values(), fit.tabulate(small_cells(), {3}).values()));
  }));
}

TEST_CASE("switch: materials measured everywhere go to the half that they came from") {
  const auto halves = gonio::split_by_contrast(shiny_and_not(), switch_reference(), {}, few_cells_regions);
  const soft_or_specular estimator{always{1.0}, always{2.0}, switch_reference(), halves.threshold, few_cells_regions};
  for (std::size_t m = 0; m < shiny_and_not().names.size(); ++m) {
    const auto samples =
        gonio::sample_table(shiny_and_not().table(m), gonio::random_cells(small_cells(), small_cells().size(), 1));
    const bool is_soft = std::ranges::count(halves.soft.names, shiny_and_not().names[m]) > 0;
    CHECK((estimator.choose(samples) == material_kind::soft) == is_soft);
  }
}

TEST_CASE("switch: the fit is black below the horizon") {
  const soft_or_specular estimator{always{1.0}, always{2.0}, switch_reference(), 0.0};
  CHECK((estimator.fit(samples_of_contrast(1.0))({0, 0, 1}, {0, 0, -1}) == 0.0).all());
}

TEST_CASE("switch: samples that do not distinguish soft from specular, and impossible regions, are refused") {
  const soft_or_specular estimator{always{1.0}, always{2.0}, switch_reference(), 0.0};
  auto samples = samples_of_contrast(1.0);
  const gonio::sample_set in_peak{samples[0]}, off_peak{samples[1]};
  CHECK_THROWS_WITH_AS((void)estimator.fit(in_peak), doctest::Contains("choice of soft or specular needs a sample"),
                       gonio::error);
  CHECK_THROWS_WITH_AS((void)estimator.choose(off_peak), doctest::Contains("up to 5.0"), gonio::error);
  samples[1].weight = 0.0;
  CHECK_THROWS_AS((void)estimator.fit(samples), gonio::error);
  CHECK_THROWS_WITH_AS((void)estimator.fit(gonio::sample_set{}), doctest::Contains("there are no samples"),
                       gonio::error);
  samples[0].value.x() = std::nan("");
  CHECK_THROWS_WITH_AS((void)estimator.fit(samples), doctest::Contains("sample 1"), gonio::error);
  const auto make = [](double threshold, const gonio::highlight_regions& regions) {
    (void)soft_or_specular{always{1.0}, always{2.0}, switch_reference(), threshold, regions};
  };
  CHECK_THROWS_WITH_AS(make(std::nan(""), {}), doctest::Contains("finite"), gonio::error);
  CHECK_THROWS_WITH_AS(make(0.0, {0.3, 0.2}), doctest::Contains("must end before"), gonio::error);
}
