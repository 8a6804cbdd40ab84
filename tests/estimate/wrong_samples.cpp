#include "../io/scratch.hpp"
#include "../synthetic_materials.hpp"
#include <gonio/estimate/reconstruction.hpp>
#include <gonio/estimate/wrong_samples.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>

#include <Eigen/Cholesky>

#include <bit>
#include <cmath>
#include <cstdlib>
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

/// A process of values with a given covariance; its components are the rows of a square root of the covariance.
gonio::sample_process process_with(const Eigen::MatrixXd& rows, double error_variance, const Eigen::MatrixXd& values) {
  const gonio::located_samples mapped{std::vector<gonio::location>(rows.rows()), values,
                                      Eigen::MatrixXd::Ones(rows.rows(), 1)};
  return {{1.0, {.variance = 0.0}},
          {rows, std::vector<gonio::half_difference>(rows.rows())},
          mapped,
          Eigen::VectorXd::Constant(rows.rows(), error_variance)};
}

/// Returns three orthonormal columns: the mean of three channels times sqrt(3), and two contrasts between them.
Eigen::Matrix3d orthonormal() {
  Eigen::Matrix3d columns;
  columns.col(0) = Eigen::Vector3d::Constant(1.0 / std::sqrt(3.0));
  columns.col(1) = Eigen::Vector3d(1.0, -1.0, 0.0) / std::sqrt(2.0);
  columns.col(2) = Eigen::Vector3d(1.0, 1.0, -2.0) / std::sqrt(6.0);
  return columns;
}

Eigen::MatrixXd brightness_of(const Eigen::MatrixXd& values) {
  return values * orthonormal().leftCols(1) / std::sqrt(3.0);
}
Eigen::MatrixXd colour_of(const Eigen::MatrixXd& values) { return values * orthonormal().rightCols(2); }

/// Returns the logarithm of a set's Student density of one property of the samples. All samples are in one direction,
/// where a shared deviation is the same for all.
double log_probability(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& values,
                       const gonio::property_rule& property, unsigned set, double everywhere = 0.0) {
  const Eigen::Index n = values.rows();
  Eigen::MatrixXd expected = covariance + Eigen::MatrixXd::Constant(n, n, everywhere);
  // For k wrong samples and an expected number of 1, the prior is B(1 + k, 1 + n - k), times the penalties.
  const auto k = static_cast<double>(std::popcount(set)), count = static_cast<double>(n);
  const double log_prior = std::lgamma(1.0 + k) + std::lgamma(1.0 + count - k) - gonio::rejection_rule{}.penalty * k;
  for (Eigen::Index i = 0; i < n; ++i)
    if ((set >> i & 1U) != 0) expected(i, i) += property.error_variance;
  const double degrees = property.degrees + count * property.degrees_per_sample;
  double squares = 0.0;
  const Eigen::LLT<Eigen::MatrixXd> factors(expected);
  for (Eigen::Index c = 0; c < values.cols(); ++c)
    squares += values.col(c).dot(factors.solve(values.col(c))) / static_cast<double>(values.cols());
  const double log_determinant = 2.0 * factors.matrixLLT().diagonal().array().log().sum();
  return log_prior - 0.5 * (log_determinant + (degrees + count) * std::log(degrees * property.scale + squares));
}

/// Returns the most probable set of at most three.
unsigned most_probable_set(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& values,
                           const gonio::property_rule& property, double everywhere = 0.0) {
  const auto log_of = [&](unsigned set) { return log_probability(covariance, values, property, set, everywhere); };
  unsigned best = 0;
  for (unsigned set = 0; set < 1U << values.rows(); ++set)
    if (std::popcount(set) <= 3 && log_of(set) > log_of(best)) best = set;
  return best;
}

}  // namespace

TEST_CASE("the sets that are found are the most probable ones, by the densities themselves") {
  constexpr Eigen::Index n = 7;
  const gonio::rejection_rule rule{.expected_number = 1.0, .largest_share = 0.5, .everywhere = {}, .in_highlight = {}};
  std::srand(1);
  int found_best = 0, of_colour = 0;
  constexpr int trials = 60;
  for (int trial = 0; trial < trials; ++trial) {
    const Eigen::MatrixXd half = 0.4 * Eigen::MatrixXd::Random(n, 10);
    const Eigen::MatrixXd covariance = half * half.transpose() + 0.05 * Eigen::MatrixXd::Identity(n, n);
    Eigen::MatrixXd values = half * Eigen::MatrixXd::Random(10, 3);
    // Errors of all channels, or of the second alone.
    for (Eigen::Index wrong = 0; wrong < trial % 4; ++wrong)
      if (trial % 3 == 0)
        values(2 * wrong, 1) += 4.0;
      else
        values.row(2 * wrong).array() += 4.0;
    const Eigen::MatrixXd brightness = brightness_of(values), colour = colour_of(values);
    const unsigned bright = most_probable_set(covariance, brightness, rule.brightness),
                   coloured = most_probable_set(covariance, colour, rule.colour);
    of_colour += coloured != 0 ? 1 : 0;
    const gonio::judged_samples judged = gonio::judge_samples(process_with(half, 0.05, values), rule);
    unsigned found = 0;
    for (const auto& sample : judged.wrong()) found |= 1U << sample.number;
    if (found != (bright | coloured)) continue;
    ++found_best;
    for (const auto& sample : judged.wrong()) {
      CHECK(judged.probabilities()[sample.number] == sample.probability);
      const unsigned one = 1U << sample.number;
      const auto right = [&](const Eigen::MatrixXd& of, const gonio::property_rule& property, unsigned set) {
        return 1.0 / (1.0 + std::exp(log_probability(covariance, of, property, set | one) -
                                     log_probability(covariance, of, property, set & ~one)));
      };
      CHECK(sample.probability ==
            doctest::Approx(1.0 - right(brightness, rule.brightness, bright) * right(colour, rule.colour, coloured)));
    }
  }
  CHECK(found_best >= trials - 4);  // the search is greedy
  CHECK(of_colour >= trials / 10);
}

TEST_CASE("samples share a deviation where that is more probable than that some of them are wrong") {
  constexpr Eigen::Index n = 7;
  constexpr double everywhere = 1.0, penalty = 2.0;
  const gonio::rejection_rule rule{.expected_number = 1.0,
                                   .largest_share = 0.5,
                                   .everywhere = {everywhere},
                                   .in_highlight = {},
                                   .everywhere_penalty = penalty};
  std::srand(2);
  int agree = 0, share = 0, compared = 0;
  constexpr int trials = 60;
  for (int trial = 0; trial < trials; ++trial) {
    const Eigen::MatrixXd half = 0.3 * Eigen::MatrixXd::Random(n, 10);
    const Eigen::MatrixXd covariance = half * half.transpose() + 0.05 * Eigen::MatrixXd::Identity(n, n);
    Eigen::MatrixXd brightness = half * Eigen::MatrixXd::Random(10, 1);
    brightness.topRows(2 + trial % 6).array() += 1.5;
    const auto log_of = [&](unsigned set, double variance) {
      return log_probability(covariance, brightness, rule.brightness, set, variance);
    };
    const auto best = [&](double variance) {
      return log_of(most_probable_set(covariance, brightness, rule.brightness, variance), variance);
    };
    const bool expected = best(everywhere) - penalty > best(0.0);
    const gonio::judged_samples judged =
        gonio::judge_samples(process_with(half, 0.05, brightness.replicate(1, 3)), rule);
    const double shared = judged.shared().everywhere;
    agree += (shared > 0.0) == expected ? 1 : 0;
    share += expected ? 1 : 0;
    // The shared deviation enters the probability that each sample is wrong.
    const unsigned set = most_probable_set(covariance, brightness, rule.brightness, shared);
    unsigned found = 0;
    for (const auto& sample : judged.wrong()) found |= 1U << sample.number;
    if (found != set) continue;
    ++compared;
    for (unsigned i = 0; i < n; ++i) {
      const double odds = log_of(set | 1U << i, shared) - log_of(set & ~(1U << i), shared),
                   probability = 1.0 / (1.0 + std::exp(-odds));
      const bool one_too_many = (set >> i & 1U) == 0 && probability > 0.5;
      CHECK(judged.probabilities()[i] == doctest::Approx(one_too_many ? 0.5 : probability));
    }
  }
  CHECK(compared > trials / 2);
  CHECK(share > trials / 6);
  CHECK(share < 5 * trials / 6);
  CHECK(agree >= trials - 2);  // the search is greedy
}

TEST_CASE("no more samples are wrong than the rule says") {
  auto samples = samples_to_judge(20);
  for (Eigen::Index i = 0; i < 20; i += 3) samples[i].value *= i % 2 == 0 ? 30.0 : 0.01;
  const auto process = judging_estimator().process_of(gonio::locate_samples(judged_cells(), samples));
  const auto wrong = [&](double largest_share) {
    const gonio::rejection_rule rule{
        .penalty = 0.0, .largest_share = largest_share, .everywhere = {}, .in_highlight = {}};
    const gonio::judged_samples judged = gonio::judge_samples(process, rule);
    Eigen::Index probably = 0;
    for (const double probability : judged.probabilities()) probably += probability > 0.5 ? 1 : 0;
    CHECK(probably == std::ssize(judged.wrong()));
    return std::ssize(judged.wrong());
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
  refused({.colour = {.error_variance = 0.0}},
          "the error variances of wrong samples must be positive and finite, not 2.900000 and 0.000000");
  refused({.largest_share = 1.0}, "the share of rejected samples must be at least 0 and less than 1, not 1.000000");
}

TEST_CASE("another sample is judged as if it had been among those that were judged") {
  auto samples = samples_to_judge(81);
  samples[80].value *= gonio::rgb(1.9, 2.2, 1.9);
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
  // They differ only by the scale of all variances, which depends on the sample itself.
  const auto odds = [](double p) { return std::log(p / (1.0 - p)); };
  CHECK(odds(probability) == doctest::Approx(odds(together.probabilities()[80])).epsilon(0.05));
}

TEST_CASE("a deviation that neighbours share is no error") {
  // All samples in the highlight are up to 31 times brighter than the prior expects. Elsewhere one sample is.
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
