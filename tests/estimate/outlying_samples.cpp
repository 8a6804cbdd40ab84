#include "../io/scratch.hpp"
#include "../synthetic_materials.hpp"
#include <gonio/estimate/outlying_samples.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>

#include <Eigen/Cholesky>

#include <algorithm>
#include <vector>

using gonio::valid_cells;

namespace {

const valid_cells& outlying_cells() {
  static const valid_cells small(gonio::grid({18, 9, 12}));
  return small;
}

const gonio::discrepancy_decomposition<gonio::log_relative>& outlying_estimator() {
  static const gonio::discrepancy_decomposition all{learn(synthetic_materials(outlying_cells(), 60), 80)};
  return all;
}

/// A material that the prior has not seen, at some cells.
gonio::sample_set clean_samples(Eigen::Index count, unsigned seed) {
  return gonio::sample_table(synthetic_materials(outlying_cells(), 3, 100 + seed).table(1),
                             gonio::random_cells(outlying_cells(), count, seed));
}

}  // namespace

TEST_CASE("each sample is predicted as a fit without it does") {
  const Eigen::MatrixXd half = Eigen::MatrixXd::Random(8, 12), values = Eigen::MatrixXd::Random(8, 3);
  const Eigen::MatrixXd covariance = half * half.transpose() + 0.1 * Eigen::MatrixXd::Identity(8, 8);
  const auto all = gonio::predict_left_out(covariance, values);
  for (Eigen::Index i = 0; i < 8; ++i) {
    std::vector<Eigen::Index> others;
    for (Eigen::Index j = 0; j < 8; ++j)
      if (j != i) others.push_back(j);
    const Eigen::MatrixXd among = covariance(others, others);
    const Eigen::VectorXd with = covariance(others, i);
    const Eigen::LLT<Eigen::MatrixXd> factors(among);
    const Eigen::RowVectorXd mean = with.transpose() * factors.solve(Eigen::MatrixXd(values(others, Eigen::all)));
    CHECK((all.mean.row(i) - mean).norm() < 1e-9);
    CHECK(all.deviation[i] == doctest::Approx(std::sqrt(covariance(i, i) - with.dot(factors.solve(with)))));
  }
  scratch::check_refused([&] { return gonio::predict_left_out(-covariance, values); }, {"not positive definite"});
}

TEST_CASE("two wrong of twenty samples are found, and what they should be is told") {
  int found = 0;
  constexpr int trials = 20;
  for (unsigned seed = 0; seed < trials; ++seed) {
    auto samples = clean_samples(20, seed);
    const gonio::rgb truth = samples[4].value;
    samples[4].value *= 10.0;
    samples[13].value *= 0.1;
    const auto located = gonio::locate_samples(outlying_cells(), samples);
    const auto sorted = gonio::reject_outlying(outlying_estimator(), located);
    CHECK(sorted.kept.size() + sorted.left_out.size() == 20);
    const bool both = sorted.left_out.size() == 2 && std::ranges::all_of(sorted.left_out, [](const auto& out) {
                        return out.number == 4 || out.number == 13;
                      });
    found += both ? 1 : 0;
    for (const auto& out : sorted.left_out) {
      CHECK(std::ranges::find(sorted.kept, out.number) == sorted.kept.end());
      CHECK((out.measured - samples[out.number].value).abs().maxCoeff() < 1e-12);
      CHECK(out.disagreement > 16.0);
      if (both && out.number == 4) CHECK((out.predicted / truth).log().abs().maxCoeff() < 4.0 * out.deviation + 0.3);
    }
  }
  CHECK(found >= 18);
}

TEST_CASE("of clean samples none is left out") {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const auto located = gonio::locate_samples(outlying_cells(), clean_samples(20, seed));
    CHECK(gonio::reject_outlying(outlying_estimator(), located).left_out.empty());
  }
}

TEST_CASE("no more samples are left out than the rule says") {
  auto samples = clean_samples(20, 3);
  for (Eigen::Index i = 0; i < 20; i += 3) samples[i].value *= i % 2 == 0 ? 30.0 : 0.01;
  const auto located = gonio::locate_samples(outlying_cells(), samples);
  CHECK(gonio::reject_outlying(outlying_estimator(), located).left_out.size() <= 4);
  CHECK(gonio::reject_outlying(outlying_estimator(), located, {.threshold = 1e-3, .largest_share = 0.1})
            .left_out.size() == 2);
  CHECK(gonio::reject_outlying(outlying_estimator(), located, {.threshold = 1e-3, .largest_share = 0.0})
            .left_out.size() == 1);
}

TEST_CASE("one or two samples are never left out") {
  auto samples = clean_samples(2, 3);
  samples[0].value *= 1000.0;
  CHECK(
      gonio::reject_outlying(outlying_estimator(), gonio::locate_samples(outlying_cells(), samples)).left_out.empty());
}

TEST_CASE("an impossible rule, and too many samples, are refused") {
  const auto located = gonio::locate_samples(outlying_cells(), clean_samples(5, 1));
  const auto refused = [&](const gonio::rejection_rule& rule) {
    scratch::check_refused([&] { return gonio::reject_outlying(outlying_estimator(), located, rule); },
                           {"positive threshold", "share from 0 up to 1"});
  };
  refused({.threshold = 0.0});
  refused({.largest_share = 1.0});
  gonio::sample_set many;
  for (int i = 0; i < 5001; ++i) many.push_back({gonio::half_difference{0.1, 0.2, 0.3}, gonio::rgb::Ones(), 1.0});
  scratch::check_refused(
      [&] { return gonio::reject_outlying(outlying_estimator(), gonio::locate_samples(outlying_cells(), many)); },
      {"at most 5000", "5001"});
}
