#include "../io/scratch.hpp"
#include "../synthetic_materials.hpp"
#include <gonio/estimate/reconstruction.hpp>
#include <gonio/estimate/wrong_samples.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>

#include <Eigen/Cholesky>

#include <bit>
#include <cmath>
#include <vector>

namespace {

const gonio::valid_cells& judged_cells() {
  static const gonio::valid_cells small(gonio::grid({18, 9, 12}));
  return small;
}

const gonio::reconstruction<gonio::log_relative>& judging_estimator() {
  static const gonio::reconstruction all{learn(synthetic_materials(judged_cells(), 60), 80)};
  return all;
}

/// Samples of a material that the prior has not seen.
gonio::sample_set samples_to_judge(Eigen::Index count) {
  return gonio::sample_table(synthetic_materials(judged_cells(), 3, 103).table(1),
                             gonio::random_cells(judged_cells(), count, 3));
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

/// The logarithm of Student's density of a set, its covariance written out: n x n for the mean and for the contrasts.
/// All samples are in one direction, where a shared deviation is the same.
double log_probability(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& values, unsigned set,
                       double everywhere = 0.0) {
  const gonio::rejection_rule rule;
  const Eigen::Index n = values.rows();
  const Eigen::MatrixXd shared = Eigen::MatrixXd::Constant(n, n, everywhere);
  Eigen::MatrixXd mean = covariance + 3.0 * shared, contrasts = covariance + 0.1 * shared;
  // Of k wrong ones, B(1 + k, 1 + n - k) for an expected number of 1.
  const auto k = static_cast<double>(std::popcount(set)), count = static_cast<double>(n);
  const double log_prior = std::lgamma(1.0 + k) + std::lgamma(1.0 + count - k);
  for (Eigen::Index i = 0; i < n; ++i) {
    const bool wrong = (set >> i & 1U) != 0;
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
  return log_prior - 0.5 * log_determinant - 0.5 * (10.0 + 2.0 * count) * std::log(10.0 + count + squares);
}

/// Of all sets of up to three.
unsigned most_probable_set(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& values, double everywhere = 0.0) {
  unsigned best = 0;
  for (unsigned set = 0; set < 1U << values.rows(); ++set)
    if (std::popcount(set) <= 3 &&
        log_probability(covariance, values, set, everywhere) > log_probability(covariance, values, best, everywhere))
      best = set;
  return best;
}

}  // namespace

TEST_CASE("the set that is found is the most probable one of all, by the densities themselves") {
  constexpr Eigen::Index n = 7;
  const gonio::rejection_rule rule{.expected_number = 1.0, .largest_share = 0.5, .everywhere = {}, .in_highlight = {}};
  int found_best = 0;
  constexpr int trials = 40;
  for (int trial = 0; trial < trials; ++trial) {
    const Eigen::MatrixXd half = Eigen::MatrixXd::Random(n, 10);
    const Eigen::MatrixXd covariance = half * half.transpose() + 0.05 * Eigen::MatrixXd::Identity(n, n);
    Eigen::MatrixXd values = half * Eigen::MatrixXd::Random(10, 3);
    for (Eigen::Index wrong = 0; wrong < trial % 4; ++wrong) values.row(2 * wrong).array() += 4.0;
    const unsigned best = most_probable_set(covariance, values);
    const gonio::sample_process process = process_with(half, 0.05, values);
    unsigned found = 0;
    const gonio::judged_samples judged = gonio::judge_samples(process, rule);
    for (const auto& sample : judged.wrong()) found |= 1U << sample.number;
    found_best += found == best ? 1 : 0;
    for (const auto& sample : judged.wrong()) {
      CHECK(judged.probabilities()[sample.number] == sample.probability);
      const double odds = log_probability(covariance, values, found) -
                          log_probability(covariance, values, found & ~(1U << sample.number));
      CHECK(sample.probability == doctest::Approx(1.0 / (1.0 + std::exp(-odds))));
    }
  }
  CHECK(found_best >= trials - 2);  // the search is greedy
}

TEST_CASE("samples share a deviation where that is more probable than that some of them are wrong") {
  constexpr Eigen::Index n = 7;
  constexpr double everywhere = 1.0, penalty = 0.2;
  const gonio::rejection_rule rule{.expected_number = 1.0,
                                   .largest_share = 0.5,
                                   .everywhere = {everywhere},
                                   .in_highlight = {},
                                   .everywhere_penalty = penalty};
  int agree = 0, share = 0;
  constexpr int trials = 60;
  for (int trial = 0; trial < trials; ++trial) {
    const Eigen::MatrixXd half = 0.3 * Eigen::MatrixXd::Random(n, 10);
    const Eigen::MatrixXd covariance = half * half.transpose() + 0.05 * Eigen::MatrixXd::Identity(n, n);
    Eigen::MatrixXd values = half * Eigen::MatrixXd::Random(10, 3);
    values.topRows(2 + trial % 6).array() += 1.5;
    const auto best = [&](double variance) {
      return log_probability(covariance, values, most_probable_set(covariance, values, variance), variance);
    };
    const bool expected = best(everywhere) - penalty > best(0.0);
    const gonio::judged_samples judged = gonio::judge_samples(process_with(half, 0.05, values), rule);
    agree += (judged.shared().everywhere > 0.0) == expected ? 1 : 0;
    share += expected ? 1 : 0;
    // What samples share counts in the probability of each to be wrong.
    unsigned found = 0;
    for (const auto& sample : judged.wrong()) found |= 1U << sample.number;
    for (unsigned i = 0; i < n; ++i) {
      const auto log_of = [&](unsigned set) {
        return log_probability(covariance, values, set, judged.shared().everywhere);
      };
      const double odds = log_of(found | 1U << i) - log_of(found & ~(1U << i));
      CHECK(judged.probabilities()[i] == doctest::Approx(1.0 / (1.0 + std::exp(-odds))));
    }
  }
  CHECK(share > trials / 6);
  CHECK(share < 5 * trials / 6);
  CHECK(agree >= trials - 2);  // the search is greedy
}

TEST_CASE("no more samples are wrong than the rule says") {
  auto samples = samples_to_judge(20);
  for (Eigen::Index i = 0; i < 20; i += 3) samples[i].value *= i % 2 == 0 ? 30.0 : 0.01;
  const auto process = judging_estimator().process_of(gonio::locate_samples(judged_cells(), samples));
  const auto wrong = [&](double largest_share) {
    const gonio::rejection_rule rule{.largest_share = largest_share, .everywhere = {}, .in_highlight = {}};
    return std::ssize(gonio::judge_samples(process, rule).wrong());
  };
  CHECK(wrong(0.6) >= 4);
  CHECK(wrong(0.1) == 2);
  CHECK(wrong(0.0) == 1);
}

TEST_CASE("an impossible rule is refused") {
  const auto process = judging_estimator().process_of(gonio::locate_samples(judged_cells(), samples_to_judge(5)));
  const auto refused = [&](const gonio::rejection_rule& rule, const char* expected) {
    scratch::check_refused([&] { return gonio::judge_samples(process, rule); }, {expected});
  };
  refused({.expected_number = -1.0}, "number of wrong samples must be positive and finite, not -1.000000");
  refused({.channel_error = 0.0},
          "the deviations of wrong samples must be positive and finite, not 1.700000 and 0.000000");
  refused({.largest_share = 1.0}, "the share of rejected samples must be at least 0 and less than 1, not 1.000000");
}

TEST_CASE("another sample is judged as if it had been among those that were judged") {
  auto samples = samples_to_judge(81);
  samples[80].value *= 1.9;
  samples[7].value *= 30.0;
  const auto located = gonio::locate_samples(judged_cells(), samples);
  std::vector<Eigen::Index> first(80), last{80};
  for (Eigen::Index i = 0; i < 80; ++i) first[i] = i;
  const auto& estimator = judging_estimator();
  const gonio::rejection_rule rule{.everywhere = {}, .in_highlight = {1.0}, .highlight_penalty = -50.0};
  const auto together = gonio::judge_samples(estimator.process_of(located), rule),
             apart = gonio::judge_samples(estimator.process_of(located.subset(first)), rule);
  REQUIRE(apart.shared().in_highlight == 1.0);
  const auto other = gonio::map_samples(estimator.prior(), located.subset(last));
  const double probability = apart.probabilities(gonio::locate_rows(estimator.prior(), other.locations), other.values,
                                                 Eigen::VectorXd::Constant(1, estimator.model().error_variance))[0];
  // But for the scale of all variances, which the sample itself says something of.
  const auto odds = [](double p) { return std::log(p / (1.0 - p)); };
  CHECK(odds(probability) == doctest::Approx(odds(together.probabilities()[80])).epsilon(0.05));
}

TEST_CASE("what neighbours have in common is no error") {
  // Every sample in the highlight is brighter than the prior believes, by up to a factor of 31; elsewhere one sample
  // is.
  auto samples = samples_to_judge(90);
  Eigen::Index alone = -1;
  std::vector<Eigen::Index> shared;
  for (Eigen::Index i = 0; i < 90; ++i) {
    const double theta_h = samples[i].angles().theta_h;
    samples[i].value *= 1.0 + 30.0 * std::exp(-std::pow(theta_h / gonio::radians(2.5), 2));
    if (theta_h < gonio::radians(6.0)) {
      shared.push_back(i);
    } else if (theta_h > gonio::radians(30.0) && alone < 0) {
      alone = i;
    }
  }
  REQUIRE(shared.size() >= 8);
  samples[alone].value *= 10.0;
  const auto found =
      gonio::judge_samples(judging_estimator().process_of(gonio::locate_samples(judged_cells(), samples)));
  CHECK(found.shared().in_highlight + found.shared().everywhere > 0.0);
  REQUIRE(!found.wrong().empty());
  CHECK(found.wrong().front().number == alone);
  for (const Eigen::Index i : shared) CHECK(found.probabilities()[i] < 0.5);
}
