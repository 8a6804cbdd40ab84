#include "../synthetic_materials.hpp"
#include <gonio/estimate/decomposition.hpp>
#include <gonio/estimate/errors_in_variables_decomposition.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>

#include <doctest/doctest.h>

namespace {

using gonio::errors_in_variables_decomposition, gonio::radians;

const gonio::valid_cells& fine_cells() {
  static const gonio::valid_cells cells(gonio::grid({24, 16, 18}));
  return cells;
}

const gonio::log_relative_pca& fine_prior() {
  static const auto basis = learn(synthetic_materials(fine_cells(), 12), 100);
  return basis;
}

std::vector<gonio::direction_pair> pairs_over_highlights() {
  std::vector<gonio::direction_pair> pairs;
  for (const double theta_h : {1.0, 4.0, 8.0, 12.0, 20.0, 35.0})
    for (const double theta_d : {10.0, 40.0})
      pairs.push_back(gonio::to_directions({radians(theta_h), radians(theta_d), 1.0}));
  return pairs;
}

/// Returns the mean over the cells of the squared mapped difference from a table.
double error_of(const gonio::brdf_table& estimate, const gonio::brdf_table& truth) {
  const auto& metric = fine_prior().metric();
  double sum = 0.0;
  for (Eigen::Index cell = 0; cell < fine_cells().size(); ++cell)
    for (Eigen::Index c = 0; c < 3; ++c)
      sum += std::pow(
          metric.forward(double{estimate.at(cell)[c]}, cell) - metric.forward(double{truth.at(cell)[c]}, cell), 2);
  return sum / static_cast<double>(fine_cells().size());
}

}  // namespace

TEST_CASE("samples without angular errors: the plain decomposition") {
  const auto materials = synthetic_materials(fine_cells(), 3, 11);
  for (std::size_t m = 0; m < 3; ++m) {
    const auto samples = gonio::sample_table_misplaced(materials.table(m), pairs_over_highlights(), 0.0);
    const auto plain = gonio::decomposition{fine_prior(), gonio::tikhonov{0.1}}.fit(samples);
    const auto same = errors_in_variables_decomposition{fine_prior(), 0.1, 0.0}.fit(samples);
    CHECK((plain.weights() - same.weights()).norm() < 1e-9 * plain.weights().norm());
  }
}

TEST_CASE("samples with angular errors: an estimator that expects them is more accurate") {
  const auto materials =
      synthetic_materials(fine_cells(), 12);  // materials of the prior: the angular error is the only error
  const double angle = radians(2.0);
  const errors_in_variables_decomposition expecting{fine_prior(), 0.01, angle};
  const gonio::decomposition trusting{fine_prior(), gonio::tikhonov{0.01}};
  double expected = 0.0, trusted = 0.0;
  for (std::size_t m = 0; m < materials.names.size(); ++m)
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      const auto truth = materials.table(m);
      const auto samples = gonio::sample_table_misplaced(truth, pairs_over_highlights(), angle, seed);
      expected += error_of(expecting.fit(samples).tabulate(fine_cells()), truth);
      trusted += error_of(trusting.fit(samples).tabulate(fine_cells()), truth);
    }
  // Measured: 0.36.
  CHECK(expected < 0.5 * trusted);
}

TEST_CASE("weights count, threads do not") {
  const auto truth = synthetic_materials(fine_cells(), 1, 5).table(0);
  auto samples = gonio::sample_table_misplaced(truth, pairs_over_highlights(), radians(1.0), 3);
  const auto one = errors_in_variables_decomposition{fine_prior(), 0.1, radians(1.0), {1}}.fit(samples),
             three = errors_in_variables_decomposition{fine_prior(), 0.1, radians(1.0), {3}}.fit(samples);
  CHECK(one.weights() == three.weights());
  // A sample of weight two equals two samples.
  auto doubled = samples;
  samples[4].weight = 2.0;
  doubled.push_back(doubled[4]);
  const errors_in_variables_decomposition estimator{fine_prior(), 0.1, radians(1.0)};
  CHECK((estimator.fit(samples).weights() - estimator.fit(doubled).weights()).norm() < 1e-8 * one.weights().norm());
  // Weights of other channels do not affect a channel.
  for (auto& s : samples) s.weight = gonio::rgb(1.0, 0.2, 3.0);
  CHECK((estimator.fit(samples).weights().col(0) - one.weights().col(0)).norm() > 0.0);
  const auto apart = errors_in_variables_decomposition{fine_prior(), 0.1, 0.0}.fit(samples).weights();
  for (auto& s : samples) s.weight = 3.0;
  const auto alike = errors_in_variables_decomposition{fine_prior(), 0.1, 0.0}.fit(samples).weights();
  CHECK((apart.col(2) - alike.col(2)).norm() < 1e-10 * alike.norm());
}

TEST_CASE("an impossible penalty, angle or sample set is refused") {
  CHECK_THROWS_WITH_AS(errors_in_variables_decomposition(fine_prior(), 0.0, 0.1), doctest::Contains("eta"),
                       gonio::error);
  CHECK_THROWS_WITH_AS(errors_in_variables_decomposition(fine_prior(), 40.0, -0.1),
                       doctest::Contains("the angular error of samples"), gonio::error);
  CHECK_THROWS_AS(errors_in_variables_decomposition(fine_prior(), 40.0, std::nan("")), gonio::error);
  CHECK_THROWS_AS((errors_in_variables_decomposition{fine_prior(), 40.0, 0.1}.fit(gonio::sample_set{})), gonio::error);
}

TEST_CASE("weights of samples with angular errors are lowered relative to the model's error") {
  const gonio::log_relative_pca prior = learn(synthetic_materials(small_cells(), 8), 6);
  const gonio::discrepancy_model model;
  gonio::sample_set samples(gonio::channels({450.0, 550.0}));
  const double angle = gonio::radians(3.0), observations = 24.0;
  for (const Eigen::Index cell : {5, 80, 200}) samples.add(small_cells().angles(cell), std::array{0.2, 0.3}, 2.0);
  const auto weighted = gonio::weighted_by_angular_error(samples, prior, model, angle);
  REQUIRE(weighted.size() == 3);
  CHECK(weighted.channels() == samples.channels());
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double error = gonio::error_variance_at(model, samples.directions(i).angles());
    const double variance = gonio::angular_error_penalty(prior, samples.directions(i).pair(), angle) / observations;
    CHECK(weighted.weight(i)[0] == doctest::Approx(2.0 * error / (error + variance)));
    CHECK(weighted.weight(i)[0] < 2.0);
    CHECK(weighted.values(i)[1] == 0.3);
  }
  CHECK(gonio::weighted_by_angular_error(samples, prior, model, 0.0).weight(1)[0] == doctest::Approx(2.0));
}
