#include "papers/noell2014/planned_decomposition.hpp"

#include "../synthetic_materials.hpp"
#include <gonio/estimate/decomposition.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/metric/lin.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/metric/log_relative.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <doctest/doctest.h>

using papers::planned_decomposition;

namespace {

/// Measurements at cells and between them of a material, the same locations for any.
struct planned_world {
  gonio::material_set set = synthetic_materials(small_cells(), 12, 5);
  gonio::sample_set locations = [] {
    gonio::sample_set found;
    for (Eigen::Index cell = 0; cell < small_cells().size(); cell += 3) {
      auto angles = small_cells().angles(cell);
      if (cell % 2 == 0) angles.theta_d *= 0.97;
      found.push_back({angles, gonio::rgb::Zero(), 1.0});
    }
    return found;
  }();

  [[nodiscard]] gonio::sample_set measurements(std::size_t material) const {
    const auto table = set.table(material);
    auto samples = locations;
    for (gonio::sample& sample : samples) sample.value = table.at(gonio::locate(small_cells(), sample.angles()));
    return samples;
  }
};

const planned_world& planned() {
  static const planned_world made;
  return made;
}

gonio::channel_values values_of(const gonio::sample_set& samples) {
  return gonio::locate_samples(small_cells(), samples).channels();
}

template <class Metric>
void check_against_decomposition(const Metric& metric) {
  const gonio::measured materials{planned().set, metric};
  const auto plan = gonio::locate_samples(small_cells(), planned().locations).locations;
  const planned_decomposition combination{materials, plan};
  for (const std::size_t material : {0u, 5u, 11u}) {
    const std::vector<std::string> itself{planned().set.names[material]};
    const auto samples = planned().measurements(material);
    const auto fit = combination.without(itself).reconstruct(values_of(samples));
    const auto expected = gonio::decomposition{materials.without(itself), gonio::nnls{}}.fit(samples);
    const auto one = fit.tabulate(small_cells()), other = expected.tabulate(small_cells());
    double differences = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < one.values().size(); ++i) {
      differences += std::pow(double{one.values()[i]} - double{other.values()[i]}, 2);
      squares += std::pow(double{other.values()[i]}, 2);
    }
    // Products in float are off by 1e-7, which the condition of a dozen materials magnifies.
    CHECK(std::sqrt(differences / squares) < 1e-4);
    CHECK(fit.weights()(material, 0) == 0.0);
    for (Eigen::Index c = 0; c < 3; ++c)
      CHECK(fit.report()->residual[c] == doctest::Approx(expected.report()->residual[c]).epsilon(1e-2));
  }
}

}  // namespace

TEST_CASE("a planned combination is the one that is not planned") {
  check_against_decomposition(gonio::lin{});
  check_against_decomposition(gonio::log{});
  check_against_decomposition(gonio::log_relative::to_median_of(planned().set));
}

TEST_CASE("planned: any solver of normal equations, the same bytes for any number of threads") {
  const gonio::measured materials{planned().set, gonio::log{}};
  const auto plan = gonio::locate_samples(small_cells(), planned().locations).locations;
  const auto values = values_of(planned().measurements(2));
  const auto fit_with = [&](unsigned threads) {
    return planned_decomposition{materials, plan, gonio::tikhonov{1e-3}, {threads}}.reconstruct(values).weights();
  };
  CHECK(fit_with(1) == fit_with(3));
  CHECK((fit_with(1).array() < 0.0).any());
}

TEST_CASE("planned: a wrong number of measurements, one that is not finite, or no materials are refused") {
  const gonio::measured materials{planned().set, gonio::log{}};
  const planned_decomposition combination{materials,
                                          gonio::locate_samples(small_cells(), planned().locations).locations};
  auto values = values_of(planned().measurements(1));
  CHECK_THROWS_WITH_AS((void)combination.reconstruct(values.leftCols(7)), doctest::Contains("there are 7 measurements"),
                       gonio::error);
  values(1, 4) = std::nanf("");
  CHECK_THROWS_WITH_AS((void)combination.reconstruct(values), doctest::Contains("not finite"), gonio::error);
  CHECK_THROWS_AS((void)combination.without(planned().set.names), gonio::error);
  CHECK_THROWS_WITH_AS((void)combination.without({"gold"}), doctest::Contains("'gold'"), gonio::error);
}
