#include "../io/scratch.hpp"
#include "../synthetic_materials.hpp"
#include <gonio/estimate/outlying_samples.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>

#include <Eigen/Cholesky>

#include <algorithm>
#include <bit>
#include <cmath>
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

TEST_CASE("the set that is found is the most probable one of all, by the densities themselves") {
  constexpr Eigen::Index n = 7;
  const gonio::rejection_rule rule{.expected_number = 1.0, .least_probability = 1e-9, .largest_share = 0.5};
  // The logarithm of Student's density of a set, its covariance written out: n x n for the mean and for the contrasts.
  const auto log_probability = [&](const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& values, unsigned set) {
    Eigen::MatrixXd mean = covariance, contrasts = covariance;
    double log_prior = 0.0;
    for (Eigen::Index i = 0; i < n; ++i) {
      const bool wrong = (set >> i & 1U) != 0;
      log_prior += std::log(wrong ? 1.0 / 7.0 : 6.0 / 7.0);
      if (!wrong) continue;
      mean(i, i) += 3.0 * std::pow(rule.common_error, 2) + std::pow(rule.channel_error, 2);
      contrasts(i, i) += std::pow(rule.channel_error, 2);
    }
    Eigen::Matrix3d orthonormal;
    orthonormal.col(0) = Eigen::Vector3d::Constant(1.0 / std::sqrt(3.0));
    orthonormal.col(1) = Eigen::Vector3d(1.0, -1.0, 0.0) / std::sqrt(2.0);
    orthonormal.col(2) = Eigen::Vector3d(1.0, 1.0, -2.0) / std::sqrt(6.0);
    const Eigen::MatrixXd turned = values * orthonormal;
    double squares = 0.0, log_determinant = 0.0;
    for (Eigen::Index c = 0; c < 3; ++c) {
      const Eigen::MatrixXd& of_channel = c == 0 ? mean : contrasts;
      const Eigen::LLT<Eigen::MatrixXd> factors(of_channel);
      squares += turned.col(c).dot(factors.solve(turned.col(c))) / 3.0;
      log_determinant += 2.0 * factors.matrixLLT().diagonal().array().log().sum() / 3.0;
    }
    return log_prior - 0.5 * log_determinant - 0.5 * (10.0 + n) * std::log(10.0 + squares);
  };
  int found_best = 0;
  constexpr int trials = 40;
  for (int trial = 0; trial < trials; ++trial) {
    const Eigen::MatrixXd half = Eigen::MatrixXd::Random(n, 10);
    const Eigen::MatrixXd covariance = half * half.transpose() + 0.05 * Eigen::MatrixXd::Identity(n, n);
    Eigen::MatrixXd values = half * Eigen::MatrixXd::Random(10, 3);
    for (Eigen::Index wrong = 0; wrong < trial % 4; ++wrong) values.row(2 * wrong).array() += 4.0;
    unsigned best = 0;
    for (unsigned set = 0; set < 1U << n; ++set)
      if (std::popcount(set) <= 3 &&
          log_probability(covariance, values, set) > log_probability(covariance, values, best))
        best = set;
    unsigned found = 0;
    for (const auto& sample : gonio::detail::find_wrong_samples(covariance, values, rule)) found |= 1U << sample.number;
    found_best += found == best ? 1 : 0;
    for (const auto& sample : gonio::detail::find_wrong_samples(covariance, values, rule)) {
      const double odds = log_probability(covariance, values, found) -
                          log_probability(covariance, values, found & ~(1U << sample.number));
      CHECK(sample.probability == doctest::Approx(1.0 / (1.0 + std::exp(-odds))));
    }
  }
  CHECK(found_best >= trials - 2);  // the search is greedy
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
      CHECK(out.probability >= 0.75);
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
  CHECK(gonio::reject_outlying(outlying_estimator(), located,
                               {.expected_number = 20.0, .least_probability = 0.01, .largest_share = 0.1})
            .left_out.size() == 2);
  CHECK(gonio::reject_outlying(outlying_estimator(), located,
                               {.expected_number = 20.0, .least_probability = 0.01, .largest_share = 0.0})
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
  const auto refused = [&](const gonio::rejection_rule& rule, const char* expected) {
    scratch::check_refused([&] { return gonio::reject_outlying(outlying_estimator(), located, rule); }, {expected});
  };
  refused({.least_probability = 0.0}, "a probability and a share below 1, not 0.000000 and 0.200000");
  refused({.largest_share = 1.0}, "a probability and a share below 1, not 0.750000 and 1.000000");
  refused({.expected_number = -1.0}, "number of wrong samples must be positive and finite, not -1.000000");
  refused({.channel_error = 0.0}, "need positive and finite deviations, not 1.700000 and 0.000000");
  gonio::sample_set many;
  for (int i = 0; i < 5001; ++i) many.push_back({gonio::half_difference{0.1, 0.2, 0.3}, gonio::rgb::Ones(), 1.0});
  scratch::check_refused(
      [&] { return gonio::reject_outlying(outlying_estimator(), gonio::locate_samples(outlying_cells(), many)); },
      {"at most 5000", "5001"});
}
