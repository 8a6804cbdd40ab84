#include "../io/scratch.hpp"
#include "../synthetic_materials.hpp"
#include <gonio/estimate/inliers.hpp>
#include <gonio/estimate/reconstruction.hpp>
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

const gonio::reconstruction<gonio::log_relative>& outlying_estimator() {
  static const gonio::reconstruction all{learn(synthetic_materials(outlying_cells(), 60), 80)};
  return all;
}

/// As `reconstruction` asks for them.
gonio::inliers inliers_of(const gonio::located_samples& samples) {
  const auto& estimator = outlying_estimator();
  return gonio::find_inliers(estimator.prior(), samples, gonio::map_samples(estimator.prior(), samples),
                             estimator.process_of(samples), estimator.model().error_variance);
}

/// A process of values with a given covariance: its components are the rows of a square root of it.
gonio::sample_process process_with(const Eigen::MatrixXd& rows, double error_variance, const Eigen::MatrixXd& values) {
  const gonio::located_samples mapped{std::vector<gonio::location>(rows.rows()), values,
                                      Eigen::MatrixXd::Ones(rows.rows(), 1)};
  return {{1.0, {.variance = 0.0}},
          {rows, std::vector<gonio::half_difference>(rows.rows())},
          mapped,
          Eigen::VectorXd::Constant(rows.rows(), error_variance)};
}

/// A material that the prior has not seen, at some cells.
gonio::sample_set clean_samples(Eigen::Index count, unsigned seed) {
  return gonio::sample_table(synthetic_materials(outlying_cells(), 3, 100 + seed).table(1),
                             gonio::random_cells(outlying_cells(), count, seed));
}

/// Samples of a material that the prior has not seen; one of them, or every tenth from the fourth on, is wrong.
gonio::located_samples with_wrong_ones(Eigen::Index count) {
  auto samples = gonio::sample_table(synthetic_materials(outlying_cells(), 3, 104).table(1),
                                     gonio::random_cells(outlying_cells(), count, 4));
  for (Eigen::Index i = 3; i < (count < 100 ? 4 : count); i += 10) samples[i].value *= 20.0;
  return gonio::locate_samples(outlying_cells(), samples);
}

}  // namespace

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
    const gonio::sample_process process = process_with(half, 0.05, values);
    unsigned found = 0;
    for (const auto& sample : gonio::find_wrong_samples(process, rule)) found |= 1U << sample.number;
    found_best += found == best ? 1 : 0;
    for (const auto& sample : gonio::find_wrong_samples(process, rule)) {
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
    const gonio::inliers sorted = inliers_of(located);
    CHECK(sorted.kept().size() + sorted.contradicted.size() == 20);
    const bool both = sorted.contradicted.size() == 2 && std::ranges::all_of(sorted.contradicted, [](const auto& out) {
                        return out.number == 4 || out.number == 13;
                      });
    found += both ? 1 : 0;
    for (const auto& out : sorted.contradicted) {
      CHECK(std::ranges::count(sorted.kept(), out.number) == 0);
      CHECK(std::ranges::count(sorted.rejected, out.number) == 1);
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
    CHECK(inliers_of(located).rejected.empty());
  }
}

TEST_CASE("no more samples are left out than the rule says") {
  auto samples = clean_samples(20, 3);
  for (Eigen::Index i = 0; i < 20; i += 3) samples[i].value *= i % 2 == 0 ? 30.0 : 0.01;
  const auto process = outlying_estimator().process_of(gonio::locate_samples(outlying_cells(), samples));
  CHECK(gonio::find_wrong_samples(process).size() <= 4);
  CHECK(gonio::find_wrong_samples(process, {.expected_number = 20.0, .least_probability = 0.01, .largest_share = 0.1})
            .size() == 2);
  CHECK(gonio::find_wrong_samples(process, {.expected_number = 20.0, .least_probability = 0.01, .largest_share = 0.0})
            .size() == 1);
}

TEST_CASE("one or two samples are never left out") {
  auto samples = clean_samples(2, 3);
  samples[0].value *= 1000.0;
  CHECK(inliers_of(gonio::locate_samples(outlying_cells(), samples)).contradicted.empty());
}

TEST_CASE("an impossible rule is refused") {
  const auto process = outlying_estimator().process_of(gonio::locate_samples(outlying_cells(), clean_samples(5, 1)));
  const auto refused = [&](const gonio::rejection_rule& rule, const char* expected) {
    scratch::check_refused([&] { return gonio::find_wrong_samples(process, rule); }, {expected});
  };
  refused({.least_probability = 0.0}, "a probability and a share below 1, not 0.000000 and 0.200000");
  refused({.largest_share = 1.0}, "a probability and a share below 1, not 0.750000 and 1.000000");
  refused({.expected_number = -1.0}, "number of wrong samples must be positive and finite, not -1.000000");
  refused({.channel_error = 0.0}, "need positive and finite deviations, not 1.700000 and 0.000000");
}

TEST_CASE("of very few samples none is rejected, but the one that disagrees is named") {
  const auto given = with_wrong_ones(12);
  const auto found = inliers_of(given);
  CHECK(found.kept().size() == 12);
  CHECK((gonio::weighted(given, found).weights.array() == given.weights.array()).all());
  CHECK(found.rejected.empty());
  CHECK(found.outlier_share == 0.0);
  REQUIRE(found.contradicted.size() == 1);
  CHECK(found.contradicted.front().number == 3);
}

TEST_CASE("of few samples those that the others contradict are rejected") {
  const auto found = inliers_of(with_wrong_ones(25));
  CHECK(found.kept().size() == 24);
  CHECK(found.rejected == std::vector<Eigen::Index>{3});
  REQUIRE(found.contradicted.size() == 1);
  CHECK(found.contradicted.front().number == 3);
  CHECK(found.outlier_share == doctest::Approx(1.0 / 25.0));
}

TEST_CASE("of many samples outliers count less, and are not named") {
  const auto given = with_wrong_ones(200);
  const auto found = inliers_of(given);
  CHECK(found.contradicted.empty());
  Eigen::Index wrong = 0;
  for (Eigen::Index i = 3; i < 200; i += 10) wrong += std::ranges::count(found.rejected, i);
  CHECK(wrong >= 16);  // of 20; a few are as bright as a highlight
  CHECK(found.rejected.size() < 50);
  CHECK(found.outlier_share > 0.05);
  CHECK(found.outlier_share < 0.3);
  CHECK(gonio::weighted(given, found).weights.minCoeff() >= 0.0);
}

TEST_CASE("of a colour outside the gamut no more samples are taken for outliers than of grey") {
  // Blue beyond Rec. 709: red is negative in every sample.
  const gonio::rgb saturated = gonio::from_xyz({0.15, 0.1, 0.9});
  REQUIRE(saturated.x() < 0.0);
  for (const Eigen::Index count : {25, 200}) {
    auto grey = with_wrong_ones(count);
    grey.values.colwise() = grey.values.col(1).eval();
    auto blue = grey;
    blue.values.array().rowwise() *= saturated.transpose();
    const auto expected = inliers_of(grey), found = inliers_of(blue);
    CHECK(found.outlier_share < expected.outlier_share + 0.05);
    CHECK(std::ranges::count(found.rejected, 3) == 1);
  }
}

TEST_CASE("few samples support no large share of outliers") {
  CHECK(gonio::largest_outlier_share(1) == 0.0);
  CHECK(gonio::largest_outlier_share(12) == 0.0);
  CHECK(gonio::largest_outlier_share(20) == doctest::Approx(0.24));
  CHECK(gonio::largest_outlier_share(100) == doctest::Approx(0.528));
  for (Eigen::Index n = 1; n < 1000; ++n) CHECK(gonio::largest_outlier_share(n) <= gonio::largest_outlier_share(n + 1));

  // Twelve samples count in full, whatever they were thought to count; of 20 at most four do not.
  CHECK(gonio::limit_outliers(Eigen::VectorXd::LinSpaced(12, 0.1, 0.9)) == Eigen::VectorXd::Ones(12));
  const Eigen::VectorXd of_twenty = gonio::limit_outliers(Eigen::VectorXd::LinSpaced(20, 0.05, 1.0));
  CHECK((of_twenty.array() < 1.0).count() == 4);
  CHECK(of_twenty[0] == doctest::Approx(0.05 / 0.25));
  CHECK(gonio::limit_outliers(Eigen::VectorXd::Zero(30)) == Eigen::VectorXd::Ones(30));
  CHECK(gonio::limit_outliers(Eigen::VectorXd()).size() == 0);
}

TEST_CASE("of many samples, what is off by more than a factor of three counts less than half") {
  for (const double ratio : {0.2, 0.4}) {
    CAPTURE(ratio);
    const auto truth = synthetic_materials(outlying_cells(), 3, 100).table(1);
    const auto cells = gonio::random_cells(outlying_cells(), 300, 4);
    const gonio::sample_set clean = gonio::sample_table(truth, cells),
                            wrong = gonio::sample_table(truth, cells, {.outlier_ratio = ratio}, 5);
    const Eigen::VectorXd weights = inliers_of(gonio::locate_samples(outlying_cells(), wrong)).weights;
    CHECK(weights.minCoeff() >= 0.0);
    CHECK(weights.maxCoeff() <= 1.0);
    Eigen::Index missed = 0, refused = 0;
    for (Eigen::Index i = 0; i < std::ssize(clean); ++i) {
      const double off = (wrong[i].value.max(0.0) + 0.01).log().mean() - (clean[i].value.max(0.0) + 0.01).log().mean();
      if (std::abs(off) > std::log(3.0)) missed += weights[i] > 0.5 ? 1 : 0;
      if (off == 0.0) refused += weights[i] < 0.5 ? 1 : 0;
    }
    CHECK(missed <= 6);
    CHECK(refused <= 15);
  }
}
