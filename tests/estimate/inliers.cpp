#include "../io/scratch.hpp"
#include "../sanitized.hpp"
#include "../synthetic_materials.hpp"
#include <gonio/estimate/inliers.hpp>
#include <gonio/estimate/reconstruction.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
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

/// Finds inliers as `reconstruction` does.
gonio::inliers inliers_of(const gonio::located_samples& samples) {
  const auto& estimator = outlying_estimator();
  const auto mapped = gonio::map_samples(estimator.prior(), samples);
  const Eigen::VectorXd errors = Eigen::VectorXd::Constant(samples.size(), estimator.model().error_variance);
  return gonio::find_inliers(estimator.prior(), estimator.expected(), samples, mapped, errors);
}

/// A material that the prior has not seen, at some cells.
gonio::sample_set clean_samples(Eigen::Index count, unsigned seed) {
  return gonio::sample_table(synthetic_materials(outlying_cells(), 3, 100 + seed).table(1),
                             gonio::random_cells(outlying_cells(), count, seed));
}

/// Samples of a material that the prior has not seen. One of them, or every tenth from the fourth on, is wrong.
gonio::located_samples with_wrong_ones(Eigen::Index count) {
  auto samples = gonio::sample_table(synthetic_materials(outlying_cells(), 3, 104).table(1),
                                     gonio::random_cells(outlying_cells(), count, 4));
  for (Eigen::Index i = 3; i < (count < 100 ? 4 : count); i += 10) samples[i].value *= 20.0;
  return gonio::locate_samples(outlying_cells(), samples);
}

/// Numbers of samples. With sanitizers, which make the search for wrong samples ten times slower, uses `few`.
std::vector<Eigen::Index> sizes(const std::vector<Eigen::Index>& all, const std::vector<Eigen::Index>& few) {
  return sanitized ? few : all;
}

}  // namespace

TEST_CASE("two wrong of twenty samples are found, and their predictions are reported") {
  int found = 0;
  constexpr int trials = 20;
  for (unsigned seed = 0; seed < trials; ++seed) {
    auto samples = clean_samples(20, seed);
    const gonio::rgb truth = samples[4].value;
    samples[4].value *= 10.0;
    samples[13].value *= 0.1;
    const auto located = gonio::locate_samples(outlying_cells(), samples);
    const gonio::inliers sorted = inliers_of(located);
    CHECK(sorted.rejected.size() == sorted.contradicted.size());
    const bool both = sorted.contradicted.size() == 2 && std::ranges::all_of(sorted.contradicted, [](const auto& out) {
                        return out.number == 4 || out.number == 13;
                      });
    found += both ? 1 : 0;
    for (const auto& out : sorted.contradicted) {
      CHECK(sorted.weights[out.number] == doctest::Approx(gonio::inlier_weight(out.probability)));
      CHECK(std::ranges::count(sorted.rejected, out.number) == 1);
      CHECK((out.measured - samples[out.number].value).abs().maxCoeff() < 1e-12);
      CHECK(out.probability >= 0.5);
      if (both && out.number == 4) CHECK((out.predicted / truth).log().abs().maxCoeff() < 4.0 * out.deviation + 0.3);
    }
  }
  CHECK(found >= 18);
}

TEST_CASE("a wrong value of a single channel is found") {
  int bright = 0, dark = 0;
  constexpr int trials = 20;
  for (unsigned seed = 0; seed < trials; ++seed) {
    const auto is_found = [&](double factor) {
      auto samples = clean_samples(20, seed);
      samples[4].value[seed % 3] *= factor;
      const gonio::inliers found = inliers_of(gonio::locate_samples(outlying_cells(), samples));
      for (const auto& out : found.contradicted)
        if (out.number == 4) CHECK(out.worst_channel() == seed % 3);
      return std::ranges::count(found.rejected, 4) == 1;
    };
    bright += is_found(5.0) ? 1 : 0;
    dark += is_found(0.2) ? 1 : 0;
  }
  CHECK(bright >= 18);
  CHECK(dark >= 18);
}

TEST_CASE("of clean samples at most one in two hundred is left out") {
  std::size_t left_out = 0;
  for (unsigned seed = 0; seed < 20; ++seed)
    left_out += inliers_of(gonio::locate_samples(outlying_cells(), clean_samples(20, seed))).rejected.size();
  CHECK(left_out <= 2);
}

TEST_CASE("one or two samples are never left out") {
  auto samples = clean_samples(2, 3);
  samples[0].value *= 1000.0;
  CHECK(inliers_of(gonio::locate_samples(outlying_cells(), samples)).contradicted.empty());
}

TEST_CASE("of few samples those that the others contradict are rejected") {
  const auto found = inliers_of(with_wrong_ones(25));
  CHECK(std::ranges::count(found.kept(), 3) == 0);
  CHECK(found.rejected == std::vector<Eigen::Index>{3});
  REQUIRE(found.contradicted.size() == 1);
  CHECK(found.contradicted.front().number == 3);
  CHECK(found.outlier_share >= 1.0 / 25.0 - 1e-6);
  CHECK(found.outlier_share < 0.07);
}

TEST_CASE("of many samples outliers are rejected, and the first of them are named") {
  for (const Eigen::Index count : sizes({200, 700}, {200})) {
    CAPTURE(count);
    const auto given = with_wrong_ones(count);
    const auto found = inliers_of(given);
    Eigen::Index wrong = 0;
    for (Eigen::Index i = 3; i < count; i += 10) wrong += std::ranges::count(found.rejected, i);
    CHECK(wrong >= 17 * count / 200);  // of 20 in 200; a few of the wrong values are as bright as a highlight
    CHECK(std::ssize(found.rejected) <= wrong + count / 100);
    CHECK(found.outlier_share == doctest::Approx(0.1).epsilon(0.25));
    CHECK(std::ssize(found.contradicted) == std::min(gonio::most_contradicted, std::ssize(found.rejected)));
    for (std::size_t i = 0; i < found.contradicted.size(); ++i) {
      const gonio::outlying_sample& out = found.contradicted[i];
      CHECK(out.number == found.rejected[i]);
      for (Eigen::Index c = 0; c < 3; ++c) CHECK(out.measured[c] == given.values(out.number, c));
    }
    CHECK(gonio::weighted(given, found).weights.minCoeff() >= 0.0);
  }
}

TEST_CASE("one more sample hardly changes the weights of the others") {
  // Across the numbers of samples at which earlier versions changed the method, and across `most_judged`.
  for (const Eigen::Index count : sizes({12, 99, 500}, {12, 99})) {
    CAPTURE(count);
    const auto more = with_wrong_ones(count + 1);
    std::vector<Eigen::Index> without(count);
    std::iota(without.begin(), without.end(), Eigen::Index{0});
    const Eigen::VectorXd fewer = inliers_of(more.subset(without)).weights,
                          weights = inliers_of(more).weights.head(count);
    Eigen::Index changed = 0;
    for (Eigen::Index i = 0; i < count; ++i) changed += (fewer[i] < 0.5) != (weights[i] < 0.5) ? 1 : 0;
    CHECK(changed <= count / 250);
  }
}

TEST_CASE("a highlight that no material of the prior has is kept where its samples agree, but not a sample alone") {
  // A lobe narrower than a degree on a material like those of the prior. Every fifth direction is on the lobe.
  for (const Eigen::Index count : sizes({60, 99, 100, 150, 400}, {60, 100})) {
    CAPTURE(count);
    gonio::sample_set samples;
    std::vector<Eigen::Index> on_lobe;
    for (Eigen::Index i = 0; i < count; ++i) {
      const double theta_d = gonio::radians(5.0 + 70.0 * static_cast<double>(i) / static_cast<double>(count));
      const bool lobe = i % 5 == 0;
      const double theta_h =
          gonio::radians(lobe ? 0.5 * static_cast<double>(i / 5 % 3) : 12.0 + static_cast<double>(i % 50));
      const gonio::half_difference angles{theta_h, theta_d, 1.0};
      if (gonio::cosines(angles).i < 0.2 || gonio::cosines(angles).o < 0.2) continue;
      const double broad = 5.0 * std::exp(-std::pow(theta_h / 0.2, 2)) * (1.0 + std::pow(theta_d, 5)),
                   narrow = 300.0 * std::exp(-std::pow(theta_h / gonio::radians(0.7), 2));
      const gonio::rgb value = gonio::rgb(0.1, 0.2, 0.15) + broad + narrow;
      if (lobe) on_lobe.push_back(std::ssize(samples));
      samples.push_back({angles, value, 1.0});
    }
    Eigen::Index alone = std::ssize(samples) - 3;
    while (samples[alone].angles().theta_h < 0.1) --alone;
    samples[alone].value *= 30.0;
    const auto found = inliers_of(gonio::locate_samples(outlying_cells(), samples));
    for (const Eigen::Index i : on_lobe) CHECK(std::ranges::count(found.rejected, i) == 0);
    CHECK(std::ranges::count(found.rejected, alone) == 1);
  }
}

TEST_CASE("of a colour outside the gamut no more samples are taken for outliers than of grey") {
  // A blue outside the gamut of Rec. 709: red is negative in every sample.
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

TEST_CASE("a sample that is probably wrong moves the estimate less than its probability of being right") {
  CHECK(gonio::inlier_weight(0.0) == 1.0);
  CHECK(gonio::inlier_weight(1.0) == 0.0);
  // Another sample predicts the value with a variance of ten times the error variance 1 of a right sample.
  for (const double wrong : {0.1, 0.5, 0.9, 0.99}) {
    const double moved = 10.0 / (10.0 + 1.0 / gonio::inlier_weight(wrong));
    CHECK(moved <= 1.0 - wrong + 1e-12);
    CHECK(moved > 0.9 * (1.0 - wrong));
  }
}

TEST_CASE("few samples support no large share of outliers") {
  CHECK(gonio::largest_outlier_share(1) == 0.0);
  CHECK(gonio::largest_outlier_share(12) == 0.0);
  CHECK(gonio::largest_outlier_share(20) == doctest::Approx(0.24));
  CHECK(gonio::largest_outlier_share(100) == doctest::Approx(0.528));
  for (Eigen::Index n = 1; n < 1000; ++n) CHECK(gonio::largest_outlier_share(n) <= gonio::largest_outlier_share(n + 1));
}

TEST_CASE("of many samples those of a narrow highlight are among those that are judged together") {
  gonio::located_samples samples;
  for (int i = 0; i < 20'000; ++i)
    samples.locations.push_back(gonio::locate(outlying_cells(), {0.5 + 1e-5 * i, 0.2 + 1e-5 * i, 0.1}));
  const std::vector<Eigen::Index> highlight{11, 4'000, 9'000, 9'001, 19'999};
  for (const Eigen::Index i : highlight) samples.locations[i] = gonio::locate(outlying_cells(), {0.01, 0.2, 0.1});
  samples.values = Eigen::MatrixXd::Ones(20'000, 3);
  const auto chosen = gonio::detail::judged_together(samples);
  CHECK(std::ssize(chosen) == gonio::most_judged);
  CHECK(std::ranges::adjacent_find(chosen, std::greater_equal<>{}) == chosen.end());  // distinct and in order
  CHECK(std::ranges::includes(chosen, highlight));
  // Two thirds are chosen from all samples, so about a tenth of these comes from the first tenth.
  CHECK(std::ranges::count_if(chosen, [](Eigen::Index i) { return i < 2'000; }) > 25);
  // With most_judged + 1 samples, all but one are chosen; of seven, all.
  std::vector<Eigen::Index> some(gonio::most_judged + 1);
  std::iota(some.begin(), some.end(), Eigen::Index{0});
  CHECK(std::ssize(gonio::detail::judged_together(samples.subset(some))) == gonio::most_judged);
  some.resize(7);
  CHECK(gonio::detail::judged_together(samples.subset(some)) == some);
}

TEST_CASE("a sample is reported by the channel that disagrees by the largest factor; negative values count as zero") {
  gonio::outlying_sample each;
  each.predicted = {0.2, 0.1, 0.05};
  each.measured = {0.25, 0.11, 0.2};
  CHECK(each.worst_channel() == 2);
  each.measured = {-0.133, 0.1, 0.2};
  CHECK(each.worst_channel() == 0);
  each.measured = each.predicted;
  CHECK(each.worst_channel() == 0);
}

TEST_CASE("of many samples, those off by more than a factor of three count less than half") {
  for (const double ratio : {0.2, 0.4}) {
    CAPTURE(ratio);
    const auto truth = synthetic_materials(outlying_cells(), 3, 100).table(1);
    const auto cells = gonio::random_cells(outlying_cells(), sanitized ? 150 : 300, 4);
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
