#include "../synthetic_materials.hpp"
#include <gonio/estimate/reconstruction.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>

#include <Eigen/Cholesky>
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using gonio::confidence_level;
using gonio::valid_cells;

namespace {

const valid_cells& posterior_cells() {
  static const valid_cells small(gonio::grid({18, 9, 12}));
  return small;
}

const gonio::reconstruction<gonio::log_relative>& posterior_estimator() {
  static const auto all = gonio::reconstruction{learn(synthetic_materials(posterior_cells(), 20), 30)}.keeping_all();
  return all;
}

/// Some cells as samples, and then a cell alone.
gonio::located_samples measured_at(const std::vector<Eigen::Index>& chosen, const gonio::brdf_table& table) {
  return gonio::locate_samples(posterior_cells(), gonio::sample_table(table, chosen));
}

/// A material drawn from the model: components, discrepancy and independent errors.
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
  const gonio::discrepancy smooth{posterior_cells(), prior.metric(),
                                  gonio::discrepancy_functions(centres, posterior_estimator().model().variance)};
  gonio::brdf_table table(posterior_cells());
  Eigen::MatrixXd components(prior.size(), 3), waves(smooth.size(), 3);
  for (Eigen::Index c = 0; c < 3; ++c) {
    components.col(c) = numbers(components.rows()) / std::sqrt(posterior_estimator().expected().observations);
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
  const auto some = measured_at({chosen.begin(), chosen.end() - 1}, table);
  const auto known = posterior_estimator().fit_located(some);
  const gonio::sample_process process = posterior_estimator().process_of(some).with_doubts();
  const auto at = gonio::locate_cell(posterior_cells(), chosen.back());
  // The variance of the last sample given the others.
  const Eigen::MatrixXd all = posterior_estimator().process_of(measured_at(chosen, table)).with_doubts().covariance();
  const Eigen::LLT<Eigen::MatrixXd> factors(all.topLeftCorner(12, 12));
  // The error that neighbouring samples share is not part of the predicted value, and so not of its covariance with
  // them.
  const gonio::discrepancy_model& model = posterior_estimator().model();
  const Eigen::VectorXd shared =
      model.doubt.shared_error_variance * gonio::discrepancy_covariance(process.at().angles, at.angles, model.lengths);
  const Eigen::VectorXd with = all.col(12).head(12) - shared;
  const double variance = all(12, 12) - model.doubt.shared_error_variance - with.dot(factors.solve(with));
  CHECK(known.deviation(at) == doctest::Approx(std::sqrt(process.scale_of_material() * variance)).epsilon(1e-6));
  // Squares of the samples relative to their expectation: in total, and the part that is not error.
  const Eigen::MatrixXd& y = process.values();
  const Eigen::MatrixXd expected = process.expected().among(process.at()), dual = factors.solve(y);
  CHECK(process.scale_of_material() == doctest::Approx((10.0 + (dual.array() * (expected * dual).array()).sum() / 3.0) /
                                                       (10.0 + factors.solve(expected).trace())));
  CHECK(process.scale() == doctest::Approx((10.0 + (y.array() * factors.solve(y).array()).sum() / 3.0) / 22.0));
}

TEST_CASE("intervals hold as often as they say on materials of the model") {
  double inside = 0.0, all = 0.0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    const gonio::brdf_table truth = drawn_material(seed);
    const auto located = measured_at(gonio::random_cells(posterior_cells(), 25, seed + 50), truth);
    const auto known = posterior_estimator().fit_located(located);
    for (const Eigen::Index cell : gonio::random_cells(posterior_cells(), 60, seed + 90)) {
      const auto at = gonio::locate_cell(posterior_cells(), cell);
      const auto [low, high] = known.interval(known.fit().at(at), at, confidence_level::ninety_five_percent);
      for (Eigen::Index c = 0; c < 3; ++c) {
        inside += truth.at(cell)[c] >= low[c] * (1.0 - 1e-6) && truth.at(cell)[c] <= high[c] * (1.0 + 1e-6) ? 1.0 : 0.0;
        all += 1.0;
      }
    }
  }
  CAPTURE(inside / all);
  CHECK(inside / all > 0.91);
  CHECK(inside / all < 0.995);  // doubts allow for materials unlike the model's
}

TEST_CASE("more samples make surer, and intervals are nested and not negative") {
  const gonio::brdf_table table = synthetic_materials(posterior_cells(), 4, 91).table(2);
  const auto few = posterior_estimator().fit_located(measured_at(gonio::random_cells(posterior_cells(), 5, 1), table));
  const auto many =
      posterior_estimator().fit_located(measured_at(gonio::random_cells(posterior_cells(), 80, 1), table));
  const auto coarse = valid_cells(gonio::grid({6, 5, 6}));
  const auto with_few = few.known_to(coarse), with_many = many.known_to(coarse);
  double sum_few = 0.0, sum_many = 0.0;
  for (Eigen::Index i = 0; i < std::ssize(coarse); ++i) {
    sum_few += with_few[i];
    sum_many += with_many[i];
  }
  CHECK(sum_many < sum_few);
  const std::vector<double> one_thread = [&] {
    const gonio::reconstruction serial(posterior_estimator().prior(), posterior_estimator().model(),
                                       gonio::thread_count(1));
    return serial.keeping_all()
        .fit_located(measured_at(gonio::random_cells(posterior_cells(), 5, 1), table))
        .known_to(coarse);
  }();
  CHECK(with_few == one_thread);
  for (const Eigen::Index cell : {0, 30, 70})
    CHECK(with_few[cell] ==
          doctest::Approx(few.known_to(gonio::locate(posterior_cells(), coarse.angles(cell)))).epsilon(1e-9));
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

TEST_CASE("certainty is the median over the directions") {
  const gonio::brdf_table table = synthetic_materials(posterior_cells(), 4, 91).table(2);
  const auto paint =
      posterior_estimator().fit_located(measured_at(gonio::random_cells(posterior_cells(), 12, 1), table));
  const gonio::certainty known = paint.certainty();
  std::vector<double> everywhere, grazing;
  const valid_cells coarse(gonio::grid({15, 9, 12}));
  for (Eigen::Index cell = 0; cell < coarse.size(); ++cell) {
    const auto [wi, wo] = gonio::to_directions(coarse.angles(cell));
    everywhere.push_back(paint.known_to(wi, wo));
    if (std::min(wi.z(), wo.z()) < std::cos(gonio::radians(80.0))) grazing.push_back(everywhere.back());
  }
  CHECK(known.known_to == doctest::Approx(gonio::median(everywhere)).epsilon(1e-3));
  CHECK(known.known_to_at_grazing == doctest::Approx(gonio::median(grazing)).epsilon(1e-3));
  CHECK(known.highlight_factor > 1.0);
  CHECK(known.known_to_outside == 0.0);  // samples cover all directions
  // More samples in the highlight make it more certain.
  auto more = gonio::sample_table(table, gonio::random_cells(posterior_cells(), 12, 1));
  for (const double theta_d : {0.3, 0.7, 1.1}) {
    const gonio::half_difference angles{0.02, theta_d, 1.5};
    more.push_back({angles, table.at(gonio::locate(posterior_cells(), angles))});
  }
  CHECK(posterior_estimator().fit(more).certainty().highlight_factor < known.highlight_factor);
}

TEST_CASE("each residual is that of a fit to all other samples") {
  auto samples = gonio::sample_table(synthetic_materials(posterior_cells(), 4, 91).table(2),
                                     gonio::random_cells(posterior_cells(), 9, 5));
  samples[3].weight = 0.0;
  const auto paint = posterior_estimator().fit(samples);
  const std::vector<gonio::sample_residual> residuals = paint.residuals();
  REQUIRE(residuals.size() == 8);
  CHECK(residuals[3].number == 4);  // sample 3 has weight zero
  for (const gonio::sample_residual& each : residuals) {
    auto others = samples;
    others[each.number].weight = 0.0;
    const auto without = posterior_estimator().fit(others);
    const auto at = gonio::locate(posterior_cells(), samples[each.number].angles());
    CHECK((each.measured - samples[each.number].value).abs().maxCoeff() < 1e-6);
    CHECK((each.predicted / without.fit().at(at) - 1.0).abs().maxCoeff() < 1e-5);
    CHECK(!each.rejected);
  }
}

TEST_CASE("samples in finer steps, and samples that are all in one region, do not make all directions surer") {
  const gonio::brdf_table table = synthetic_materials(posterior_cells(), 4, 91).table(2);
  const auto beyond = gonio::locate(posterior_cells(), {gonio::radians(55.0), gonio::radians(20.0), 0.5});
  const auto near = gonio::locate(posterior_cells(), {gonio::radians(4.0), gonio::radians(20.0), 0.5});
  const auto scan = [&](int samples) {
    std::vector<Eigen::Index> cells;
    gonio::sample_set measured;
    for (int i = 0; i < samples; ++i) {
      const gonio::half_difference angles{gonio::radians(15.0 * i / samples), gonio::radians(20.0), 0.5};
      const auto at = gonio::locate(posterior_cells(), angles);
      measured.push_back({angles, gonio::rgb(table.at(at.cell[0])), 1.0});
    }
    return posterior_estimator().fit(measured);
  };
  const auto coarse = scan(8), fine = scan(64);
  CHECK(fine.deviation(beyond) > 0.9 * coarse.deviation(beyond));
  CHECK(fine.deviation(beyond) > 3.0 * fine.deviation(near));
  // If a value is wholly unknown, the errors are nearly normal. If it is nearly known, they have heavier tails.
  const auto deviations_reached = [&](const gonio::location& at, gonio::confidence_level level) {
    return fine.half_width(at, level) / fine.deviation(at);
  };
  CHECK(deviations_reached(beyond, gonio::confidence_level::sixty_eight_percent) > 0.75);
  CHECK(deviations_reached(near, gonio::confidence_level::sixty_eight_percent) < 0.55);
  CHECK(deviations_reached(near, gonio::confidence_level::ninety_five_percent) == doctest::Approx(1.85));
  // The uncertainty far from all measured half vectors is stated separately.
  const gonio::certainty known = fine.certainty();
  CHECK(gonio::degrees(known.measured_to) == doctest::Approx(15.0 * 63.0 / 64.0));
  CHECK(known.known_to_outside > known.known_to);
}

TEST_CASE("no estimate dips in the mirror direction, in its table and where it is evaluated") {
  const valid_cells& cells = posterior_cells();
  Eigen::Index filled = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    const auto paint =
        posterior_estimator().fit_located(measured_at(gonio::random_cells(cells, 8, seed + 20), drawn_material(seed)));
    const gonio::brdf_table table = paint.tabulate(cells), fit = paint.fit().tabulate(cells);
    for (Eigen::Index cell = 0; cell < cells.size(); ++cell) {
      const gonio::half_difference angles = cells.angles(cell);
      const auto [wi, wo] = gonio::to_directions(angles);
      if (wi.z() < 0.02 || wo.z() < 0.02) continue;
      const gonio::rgb value = paint(wi, wo), told = table.at(cell);
      REQUIRE((value - told).abs().maxCoeff() <= 1e-3 * told.maxCoeff());
      REQUIRE((paint.values(wi, wo) - value).abs().maxCoeff() <= 1e-3 * value.maxCoeff());
      filled += gonio::luminance(told) > 1.01 * gonio::luminance(gonio::rgb(fit.at(cell))) ? 1 : 0;
      if (angles.theta_h >= gonio::radians(8.0)) REQUIRE((told == gonio::rgb(fit.at(cell))).all());
    }
  }
  CHECK(filled > 0);
}
