#include "../synthetic_materials.hpp"
#include <gonio/design/sequential_design.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <random>

namespace {

using estimator_type = gonio::reconstruction<gonio::log_relative>;

const gonio::design::sequential_design<gonio::log_relative>& sequence() {
  static const gonio::design::sequential_design candidates(
      estimator_type{learn(synthetic_materials(small_cells(), 12), 10)}, {}, small_cells());
  return candidates;
}

gonio::located_samples some_samples(const std::vector<Eigen::Index>& cells) {
  static const auto table = synthetic_materials(small_cells(), 1, 99).table(0);
  return gonio::locate_samples(small_cells(), gonio::sample_table(table, cells));
}

gonio::sample_process process_of_some(const std::vector<Eigen::Index>& cells) {
  return sequence().estimator().process_of(some_samples(cells));
}

gonio::design::sensitivity random_sensitivity(Eigen::Index points) {
  std::mt19937 generator(5);
  std::normal_distribution<double> normal;
  gonio::design::sensitivity seen{Eigen::MatrixXd(3 * points, small_cells().size()),
                                  Eigen::VectorXd::Constant(points, 1.0 / static_cast<double>(points))};
  for (Eigen::Index c = 0; c < seen.slopes.cols(); ++c)
    for (Eigen::Index r = 0; r < seen.slopes.rows(); ++r) seen.slopes(r, c) = normal(generator);
  return seen;
}

}  // namespace

TEST_CASE("the posterior over candidates is the estimator's fit, and its deviations are those of the process") {
  const gonio::located_samples samples = some_samples({3, 50, 120, 200});
  const auto estimator = sequence().estimator().keeping_all();
  const gonio::sample_process process = estimator.process_of(samples);
  const auto known = sequence().posterior_of(process);
  const auto paint = estimator.fit_located(samples);
  const auto fit = paint.tabulate(small_cells());
  for (Eigen::Index cell = 0; cell < small_cells().size(); cell += 37) {
    const gonio::location& at = sequence().locations()[cell];
    CHECK(estimator.prior().metric().inverse(known.mean(cell, 1), at) ==
          doctest::Approx(fit.at(cell)[1]).epsilon(3e-3));
    const double deviation = process.deviations(gonio::locate_rows(estimator.prior(), {&at, 1}))[0],
                 variance = deviation * deviation - gonio::error_variance_at(estimator.model(), at.angles);
    CHECK(known.covariance(cell, cell) == doctest::Approx(variance).epsilon(1e-6));
    // The deviation of the fit also includes the doubts.
    CHECK(paint.deviation(at) > std::sqrt(process.scale()) * deviation);
  }
}

TEST_CASE("a candidate's value is that of the covariance with its measurement, on any number of threads") {
  const auto known = sequence().posterior_of(process_of_some({3, 50, 120}));
  const auto seen = random_sensitivity(4);
  const auto each = gonio::design::seen_deviation_with_each(known.covariance, seen, sequence().error_variances());
  const double before = gonio::design::seen_deviation(known.covariance, seen);
  for (const Eigen::Index candidate : {0, 77, 150}) {
    auto with = known;
    with.add(candidate, sequence().error_variances()[candidate]);
    CHECK(each[candidate] == doctest::Approx(gonio::design::seen_deviation(with.covariance, seen)).epsilon(1e-8));
    CHECK(each[candidate] <= before);
    // Agrees with the posterior after measuring the candidate.
    auto samples = std::vector<Eigen::Index>{3, 50, 120, candidate};
    const auto measured = sequence().posterior_of(process_of_some(samples));
    CHECK((measured.covariance - with.covariance).cwiseAbs().maxCoeff() < 1e-6);
  }
  CHECK(each == gonio::design::seen_deviation_with_each(known.covariance, seen, sequence().error_variances(),
                                                        gonio::thread_count{1}));
}

TEST_CASE("with nothing measured the prior is what is known; the default candidates are 3,246") {
  const auto known = sequence().prior();
  CHECK(known.mean.rows() == small_cells().size());
  CHECK(known.mean(5, 0) == doctest::Approx(sequence().estimator().prior().offset(5)));
  CHECK(gonio::design::default_candidates().size() == 3246);
}
