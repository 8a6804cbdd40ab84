#include "../synthetic_materials.hpp"
#include <gonio/estimate/screened_samples.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>

#include <doctest/doctest.h>

#include <algorithm>

namespace {

const gonio::valid_cells& screened_cells() {
  static const gonio::valid_cells small(gonio::grid({18, 9, 12}));
  return small;
}

const gonio::discrepancy_decomposition<gonio::log_relative>& screened_estimator() {
  static const gonio::discrepancy_decomposition all{learn(synthetic_materials(screened_cells(), 60), 80)};
  return all;
}

/// Samples of a material that the prior has not seen; one of them, or every tenth from the fourth on, is wrong.
gonio::located_samples with_wrong_ones(Eigen::Index count) {
  auto samples = gonio::sample_table(synthetic_materials(screened_cells(), 3, 104).table(1),
                                     gonio::random_cells(screened_cells(), count, 4));
  for (Eigen::Index i = 3; i < (count < 100 ? 4 : count); i += 10) samples[i].value *= 20.0;
  return gonio::locate_samples(screened_cells(), samples);
}

}  // namespace

TEST_CASE("of very few samples none is left out, but the one that disagrees is named") {
  const auto given = with_wrong_ones(12);
  const auto found = gonio::screen(screened_estimator(), given);
  CHECK(found.kept.size() == 12);
  CHECK((found.kept.weights.array() == given.weights.array()).all());
  CHECK(found.left_out.empty());
  CHECK(found.outlier_share == 0.0);
  REQUIRE(found.contradicted.size() == 1);
  CHECK(found.contradicted.front().number == 3);
}

TEST_CASE("of few samples those that the others contradict are left out") {
  const auto found = gonio::screen(screened_estimator(), with_wrong_ones(25));
  CHECK(found.kept.size() == 24);
  CHECK(found.left_out == std::vector<Eigen::Index>{3});
  REQUIRE(found.contradicted.size() == 1);
  CHECK(found.contradicted.front().number == 3);
  CHECK(found.outlier_share == doctest::Approx(1.0 / 25.0));
}

TEST_CASE("of many samples outliers count less, and are not named") {
  const auto given = with_wrong_ones(200);
  const auto found = gonio::screen(screened_estimator(), given);
  CHECK(found.contradicted.empty());
  Eigen::Index wrong = 0;
  for (Eigen::Index i = 3; i < 200; i += 10) wrong += std::ranges::count(found.left_out, i);
  CHECK(wrong >= 16);  // of 20; a few are as bright as a highlight
  CHECK(found.left_out.size() < 50);
  CHECK(found.outlier_share > 0.05);
  CHECK(found.outlier_share < 0.3);
  CHECK(found.kept.weights.minCoeff() >= 0.0);
}

TEST_CASE("inlier weights say which samples of the given ones are kept, so that others of the same places can be") {
  for (const Eigen::Index count : {12, 25, 200}) {
    const auto given = with_wrong_ones(count);
    const auto found = gonio::screen(screened_estimator(), given);
    REQUIRE(found.inlier_weights.size() == count);
    const auto again = gonio::robust_decomposition<gonio::log_relative>::weighted(given, found.inlier_weights);
    CHECK(again.values == found.kept.values);
    CHECK(again.weights == found.kept.weights);
    // As many channels as there are stay.
    gonio::located_samples wide = given;
    wide.values = given.values.replicate(1, 3).eval();
    CHECK(gonio::robust_decomposition<gonio::log_relative>::weighted(wide, found.inlier_weights).values ==
          found.kept.values.replicate(1, 3));
  }
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
    const auto expected = gonio::screen(screened_estimator(), grey), found = gonio::screen(screened_estimator(), blue);
    CHECK(found.outlier_share < expected.outlier_share + 0.05);
    CHECK(std::ranges::count(found.left_out, 3) == 1);
    // What is kept are the colours as they were given.
    CHECK(found.kept.values.col(0).maxCoeff() < 0.0);
  }
}
