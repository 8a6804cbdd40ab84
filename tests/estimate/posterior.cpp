#include "../synthetic_materials.hpp"
#include <gonio/estimate/posterior.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>

#include <Eigen/Cholesky>
#include <doctest/doctest.h>

#include <cmath>
#include <random>

using gonio::confidence_level;
using gonio::valid_cells;

namespace {

const valid_cells& posterior_cells() {
  static const valid_cells small(gonio::grid({18, 9, 12}));
  return small;
}

const gonio::discrepancy_decomposition<gonio::log_relative>& posterior_estimator() {
  static const gonio::discrepancy_decomposition all{learn(synthetic_materials(posterior_cells(), 20), 30)};
  return all;
}

/// Some cells as samples, and then a cell alone.
gonio::located_samples measured_at(const std::vector<Eigen::Index>& chosen, const gonio::brdf_table& table) {
  return gonio::locate_samples(posterior_cells(), gonio::sample_table(table, chosen));
}

/// A material drawn from the model itself: components, discrepancy and independent errors.
gonio::brdf_table drawn_material(unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto numbers = [&](Eigen::Index count) {
    Eigen::VectorXd all(count);
    for (double& each : all) each = normal(random);
    return all;
  };
  const auto& prior = posterior_estimator().prior();
  std::vector<gonio::half_difference> centres;
  for (const Eigen::Index cell : gonio::random_cells(posterior_cells(), 120, seed))
    centres.push_back(posterior_cells().angles(cell));
  const gonio::discrepancy smooth{posterior_cells(), prior.metric(), centres, posterior_estimator().model().variance};
  gonio::brdf_table table(posterior_cells());
  Eigen::MatrixXd components(prior.size(), 3), waves(smooth.size(), 3);
  for (Eigen::Index c = 0; c < 3; ++c) {
    components.col(c) = numbers(components.rows()) / std::sqrt(posterior_estimator().observations());
    waves.col(c) = numbers(waves.rows());
  }
  for (Eigen::Index cell = 0; cell < posterior_cells().size(); ++cell) {
    const auto at = gonio::locate_cell(posterior_cells(), cell);
    const Eigen::RowVector3d y = gonio::row_at(prior, at) * components + gonio::row_at(smooth, at) * waves;
    gonio::rgb value;
    for (Eigen::Index c = 0; c < 3; ++c)
      value[c] = std::max(
          prior.metric().inverse(
              y[c] + prior.offset(cell) + std::sqrt(posterior_estimator().model().error_variance) * normal(random), at),
          0.0);
    table.set(cell, value);
  }
  return table;
}

}  // namespace

TEST_CASE("the deviation is that of the textbook, times the scale") {
  const gonio::brdf_table table = synthetic_materials(posterior_cells(), 4, 91).table(2);
  auto chosen = gonio::random_cells(posterior_cells(), 13, 3);
  const gonio::posterior known(posterior_estimator(), measured_at({chosen.begin(), chosen.end() - 1}, table));
  // The last sample's variance given the others.
  const Eigen::MatrixXd all = posterior_estimator().covariance(measured_at(chosen, table));
  const Eigen::LLT<Eigen::MatrixXd> factors(all.topLeftCorner(12, 12));
  const double variance = all(12, 12) - all.col(12).head(12).dot(factors.solve(all.col(12).head(12)));
  const auto at = gonio::locate_cell(posterior_cells(), chosen.back());
  CHECK(known.deviation(at) == doctest::Approx(std::sqrt(known.scale() * variance)).epsilon(1e-6));
  // What the samples are, relative to what was expected.
  const Eigen::MatrixXd y = posterior_estimator().mapped_values(measured_at({chosen.begin(), chosen.end() - 1}, table));
  CHECK(known.scale() == doctest::Approx((10.0 + (y.array() * factors.solve(y).array()).sum() / 3.0) / 22.0));
}

TEST_CASE("intervals hold as often as they say on materials of the model") {
  double inside = 0.0, all = 0.0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    const gonio::brdf_table truth = drawn_material(seed);
    const auto located = measured_at(gonio::random_cells(posterior_cells(), 25, seed + 50), truth);
    const auto fit = posterior_estimator().fit_located(located);
    const gonio::posterior known(posterior_estimator(), located);
    for (const Eigen::Index cell : gonio::random_cells(posterior_cells(), 60, seed + 90)) {
      const auto at = gonio::locate_cell(posterior_cells(), cell);
      const auto [low, high] = known.interval(fit.at(at), at, confidence_level::ninety_five_percent);
      for (Eigen::Index c = 0; c < 3; ++c) {
        inside += truth.at(cell)[c] >= low[c] * (1.0 - 1e-6) && truth.at(cell)[c] <= high[c] * (1.0 + 1e-6) ? 1.0 : 0.0;
        all += 1.0;
      }
    }
  }
  CAPTURE(inside / all);
  CHECK(inside / all > 0.91);
  CHECK(inside / all < 0.985);
}

TEST_CASE("more samples make surer, and intervals are nested and not negative") {
  const gonio::brdf_table table = synthetic_materials(posterior_cells(), 4, 91).table(2);
  const gonio::posterior few(posterior_estimator(), measured_at(gonio::random_cells(posterior_cells(), 5, 1), table));
  const gonio::posterior many(posterior_estimator(), measured_at(gonio::random_cells(posterior_cells(), 80, 1), table));
  const auto coarse = valid_cells(gonio::grid({6, 5, 6}));
  const auto with_few = few.deviations(coarse), with_many = many.deviations(coarse);
  double sum_few = 0.0, sum_many = 0.0;
  for (Eigen::Index i = 0; i < std::ssize(coarse); ++i) {
    sum_few += with_few[i];
    sum_many += with_many[i];
  }
  CHECK(sum_many < sum_few);
  const auto at = gonio::locate_cell(posterior_cells(), 77);
  const gonio::rgb value(1e-5, 0.3, 2.0);
  const auto narrow = few.interval(value, at, confidence_level::sixty_eight_percent);
  const auto wide = few.interval(value, at, confidence_level::ninety_five_percent);
  CHECK((narrow.low >= wide.low).all());
  CHECK((narrow.high <= wide.high).all());
  CHECK((wide.low >= 0.0).all());
  CHECK((narrow.low <= value).all());
  CHECK((narrow.high >= value * (1.0 - 1e-9)).all());
}
