#include "../io/scratch.hpp"
#include "../synthetic_materials.hpp"
#include <gonio/conformity/conformity.hpp>
#include <gonio/core/probability.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

using gonio::valid_cells;

namespace {

const valid_cells& conformity_cells() {
  static const valid_cells small(gonio::grid({18, 9, 12}));
  return small;
}

const gonio::reconstruction<gonio::log_relative>& conformity_estimator() {
  static const gonio::reconstruction all{learn(synthetic_materials(conformity_cells(), 60), 80)};
  return all;
}

/// Returns a material that the prior has not seen.
const gonio::brdf_table& checked_material(Eigen::Index number = 1) {
  static const auto set = synthetic_materials(conformity_cells(), 3, 101);
  static const std::vector<gonio::brdf_table> tables{set.table(0), set.table(1), set.table(2)};
  return tables[number];
}

/// Returns some cells of a table times a factor, with relative noise in each channel.
gonio::located_samples noisy(const gonio::brdf_table& table, const std::vector<Eigen::Index>& cells, double noise,
                             unsigned seed, const gonio::rgb& factor = gonio::rgb::Ones()) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  auto samples = gonio::sample_table(table, cells);
  for (auto& each : samples)
    for (Eigen::Index c = 0; c < 3; ++c) each.value[c] *= factor[c] * (1.0 + noise * normal(random));
  return gonio::locate_samples(conformity_cells(), samples);
}

gonio::conformity_options noise_of(double relative) { return {.part = {relative}, .reference = {relative}}; }

std::vector<Eigen::Index> some_cells(Eigen::Index count, unsigned seed) {
  return gonio::random_cells(conformity_cells(), count, seed);
}

/// Returns the fraction of parts, `factor` times the reference, that are reported as different.
double alarms(const std::vector<Eigen::Index>& cells, int trials, double level,
              const gonio::conformity_options& options, const gonio::rgb& factor = gonio::rgb::Ones()) {
  int found = 0;
  for (int t = 0; t < trials; ++t)
    found += gonio::check_conformity(conformity_estimator(), noisy(checked_material(), cells, 0.02, 2 * t, factor),
                                     noisy(checked_material(), cells, 0.02, 2 * t + 1), options)
                     .conforms(level)
                 ? 0
                 : 1;
  return static_cast<double>(found) / trials;
}

}  // namespace

TEST_CASE("one shared direction is a chi-square of three channels") {
  const auto part = noisy(checked_material(), {77}, 0.0, 0, {1.05, 1.0, 0.97});
  const auto reference = noisy(checked_material(), {77}, 0.0, 0);
  const auto found = gonio::check_conformity(conformity_estimator(), part, reference,
                                             {.part = {0.02}, .reference = {.relative = 0.01, .dark = 0.003}});
  const auto& metric = conformity_estimator().prior().metric();
  const gonio::location& at = part.locations[0];
  double square = 0.0;
  for (Eigen::Index c = 0; c < 3; ++c) {
    const double p = part.values(0, c), r = reference.values(0, c), reach = std::hypot(0.01 * r, 0.003);
    const double of_part = 0.5 * (metric.forward(1.02 * p, at) - metric.forward(0.98 * p, at));
    const double of_reference = 0.5 * (metric.forward(r + reach, at) - metric.forward(r - reach, at));
    const double difference = metric.forward(p, at) - metric.forward(r, at);
    square += difference * difference / (of_part * of_part + of_reference * of_reference);
    CHECK(found.directions[0].difference[c] == doctest::Approx(difference));
    CHECK(found.directions[0].expected[c] == doctest::Approx(r));
    CHECK(found.directions[0].deviation[c] == doctest::Approx(std::hypot(of_part, of_reference)));
  }
  CHECK(found.p_value == doctest::Approx(gonio::chi_square_tail(square, 3.0)).epsilon(1e-6));
  CHECK(found.p_value == found.directions[0].p_value);
  CHECK(found.directions[0].measured == 1);
  CHECK(found.predicted() == 0);
}

TEST_CASE("false alarms are as many as stated, whether noise is known or told by repeats") {
  constexpr int trials = 1500;
  const auto cells = some_cells(8, 5);
  for (const double level : {0.01, 0.05, 0.2}) {
    const double rate = alarms(cells, trials, level, noise_of(0.02)), error = std::sqrt(level * (1.0 - level) / trials);
    CAPTURE(rate);
    CHECK(rate < level + 3.0 * error);
    CHECK(rate > 0.3 * level - 3.0 * error);
  }
  std::vector<Eigen::Index> twice = some_cells(4, 6);
  twice.insert(twice.end(), twice.begin(), twice.end());
  int found = 0;
  for (int t = 0; t < trials; ++t) {
    const auto part = noisy(checked_material(), twice, 0.02, 2 * t),
               reference = noisy(checked_material(), twice, 0.02, 2 * t + 1);
    const auto& metric = conformity_estimator().prior().metric();
    const auto noise =
        gonio::pooled_noise(gonio::noise_of_repeats(metric, part), gonio::noise_of_repeats(metric, reference));
    REQUIRE(noise.degrees_of_freedom == 24.0);
    found += gonio::check_conformity(conformity_estimator(), part, reference, {.part = noise, .reference = noise})
                     .conforms(0.05)
                 ? 0
                 : 1;
  }
  CAPTURE(found);
  CHECK(found < trials * (0.05 + 3.0 * std::sqrt(0.05 * 0.95 / trials)));
  CHECK(found > trials * 0.01);
}

TEST_CASE("a shift of one channel is found and told, and a direction that differs is named") {
  const auto cells = some_cells(12, 7);
  const auto reference = noisy(checked_material(), cells, 0.02, 1);
  const auto shifted = gonio::check_conformity(
      conformity_estimator(), noisy(checked_material(), cells, 0.02, 2, {1.1, 1.0, 1.0}), reference, noise_of(0.02));
  CHECK_FALSE(shifted.conforms(1e-4));
  CHECK(shifted.shift_p_value < shifted.total_p_value);
  CHECK(shifted.shift[0] == doctest::Approx(std::log(1.1)).epsilon(0.3));
  CHECK(std::abs(shifted.shift[1]) < 0.03);

  auto part = noisy(checked_material(), cells, 0.02, 3);
  part.values.row(7) *= 1.3;
  const auto named = gonio::check_conformity(conformity_estimator(), part, reference, noise_of(0.02));
  CHECK_FALSE(named.conforms(1e-4));
  CHECK(named.worst() == 7);
  CHECK((named.directions[7].value - part.values.row(7).transpose().array()).abs().maxCoeff() < 1e-12);
  for (const auto& each : named.directions) {
    CHECK(each.adjusted_p_value >= each.p_value);
    if (each.number != 7) CHECK(each.adjusted_p_value > 0.01);
  }
  CHECK(named.directions[7].adjusted_p_value == doctest::Approx(12.0 * named.directions[7].p_value));
}

TEST_CASE("what is within the tolerance is no difference, what is well beyond is") {
  gonio::conformity_options options = noise_of(0.02);
  options.tolerance = {0.06};
  const auto cells = some_cells(8, 5);
  CHECK(alarms(cells, 200, 0.05, options) == 0.0);
  CHECK(alarms(cells, 500, 0.05, options, {1.05, 0.95, 1.05}) < 0.05 + 3.0 * std::sqrt(0.05 * 0.95 / 500));
  CHECK(alarms(cells, 100, 0.05, options, gonio::rgb::Constant(1.2)) > 0.95);
  // With a diagonal precision matrix, each residual moves towards zero by its tolerance, but not past zero.
  const Eigen::VectorXd residuals = (Eigen::VectorXd(3) << 0.3, -0.05, -0.2).finished();
  const Eigen::VectorXd tolerance = (Eigen::VectorXd(3) << 0.1, 0.1, 0.0).finished();
  const Eigen::MatrixXd precision = Eigen::Vector3d(2.0, 3.0, 4.0).asDiagonal();
  CHECK(gonio::detail::least_within(precision, residuals, tolerance) == doctest::Approx(2.0 * 0.04 + 4.0 * 0.04));
  CHECK(gonio::detail::least_within(precision, residuals, Eigen::VectorXd::Zero(3)) ==
        doctest::Approx(2.0 * 0.09 + 3.0 * 0.0025 + 4.0 * 0.04));
}

TEST_CASE("the least within a tolerance is below that of any allowed difference, correlated or not") {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int t = 0; t < 20; ++t) {
    const Eigen::MatrixXd half = Eigen::MatrixXd::NullaryExpr(6, t % 2 == 0 ? 6 : 2, [&] { return normal(random); });
    const Eigen::MatrixXd matrix = half * half.transpose();
    const Eigen::VectorXd residuals = Eigen::VectorXd::NullaryExpr(6, [&] { return normal(random); });
    const Eigen::VectorXd tolerance = Eigen::VectorXd::Constant(6, 0.4);
    const double least = gonio::detail::least_within(matrix, residuals, tolerance);
    CHECK(least >= 0.0);
    for (int draws = 0; draws < 200; ++draws) {
      const Eigen::VectorXd left = residuals - Eigen::VectorXd::NullaryExpr(6, [&] { return 0.4 * uniform(random); });
      CHECK(least <= left.dot(matrix * left) * (1.0 + 1e-6) + 1e-9);
    }
  }
}

TEST_CASE("tolerances of each channel, and of the highlight") {
  const auto cells = some_cells(8, 5);
  gonio::conformity_options options = noise_of(0.02);
  options.tolerance = {0.3, 0.0, 0.0};
  CHECK(alarms(cells, 100, 0.05, options, {1.2, 1.0, 1.0}) < 0.12);  // green and blue alone raise alarms
  CHECK(alarms(cells, 100, 0.05, options, {1.0, 1.2, 1.0}) > 0.95);
  // The tolerance of the peak applies only to cells below 5 degrees.
  options.tolerance = {0.0};
  options.peak_tolerance = 0.3;
  CHECK(alarms(cells, 100, 0.05, options, gonio::rgb::Constant(1.2)) > 0.95);
  std::vector<Eigen::Index> peak;
  for (Eigen::Index cell = 0; cell < conformity_cells().size() && peak.size() < 8; cell += 7)
    if (conformity_cells().angles(cell).theta_h < gonio::radians(5.0)) peak.push_back(cell);
  REQUIRE(peak.size() == 8);
  CHECK(alarms(peak, 100, 0.05, options, gonio::rgb::Constant(1.2)) == 0.0);
}

TEST_CASE("a tolerance of Delta E: colours within it conform, others do not") {
  const auto cells = some_cells(8, 5);
  gonio::conformity_options options = noise_of(0.005);
  const gonio::rgb redder{1.1, 1.0, 1.0};
  const auto found = gonio::check_conformity(conformity_estimator(), noisy(checked_material(), cells, 0.0, 1, redder),
                                             noisy(checked_material(), cells, 0.0, 2), options);
  double least = 1e9, most = 0.0;
  for (const auto& each : found.directions) {
    const gonio::rgb one = each.expected, other = one * redder;
    CHECK(each.delta_e == doctest::Approx(gonio::detail::delta_e_of(one, other)).epsilon(0.02));
    least = std::min(least, each.delta_e);
    most = std::max(most, each.delta_e);
  }
  const auto share = [&](double tolerance) {
    options.delta_e = tolerance;
    int said = 0;
    for (int t = 0; t < 60; ++t)
      said += gonio::check_conformity(conformity_estimator(), noisy(checked_material(), cells, 0.005, 2 * t, redder),
                                      noisy(checked_material(), cells, 0.005, 2 * t + 1), options)
                      .conforms()
                  ? 0
                  : 1;
    return said / 60.0;
  };
  CHECK(share(1.1 * most) < 0.05);
  CHECK(share(0.5 * most) > 0.9);
  CHECK(least < most);
}

TEST_CASE("the least within an ellipsoid is that of the nearest allowed difference") {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  const auto draw = [&] { return normal(random); };
  for (int t = 0; t < 20; ++t) {
    const Eigen::Matrix3d half = Eigen::Matrix3d::NullaryExpr(draw);
    const Eigen::Matrix3d matrix = half * half.transpose() + 0.1 * Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d jacobian = Eigen::Matrix3d::NullaryExpr(draw) + 3.0 * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d residuals = 3.0 * Eigen::Vector3d::NullaryExpr(draw);
    const double reach = 0.5 * (jacobian * residuals).norm();
    CHECK(gonio::detail::least_within(matrix, residuals, jacobian, 2.001 * reach) == 0.0);
    CHECK(gonio::detail::least_within(matrix, residuals, jacobian, 1e-9) ==
          doctest::Approx(residuals.dot(matrix * residuals)).epsilon(1e-6));
    const double least = gonio::detail::least_within(matrix, residuals, jacobian, reach);
    double found = 1e300;
    for (int draws = 0; draws < 20000; ++draws) {
      const Eigen::Vector3d u = reach * Eigen::Vector3d::NullaryExpr(draw).normalized();
      const Eigen::Vector3d left = residuals - jacobian.inverse() * u;
      found = std::min(found, left.dot(matrix * left));
    }
    CHECK(least <= found * (1.0 + 1e-9));
    CHECK(least > 0.97 * found - 1e-9);
  }
}

TEST_CASE("other directions are predicted: the same material conforms, another one does not") {
  int alike = 0, different = 0;
  constexpr int trials = 40;
  for (unsigned t = 0; t < trials; ++t) {
    const auto part = noisy(checked_material(), some_cells(8, 2 * t), 0.02, 2 * t);
    const auto reference = noisy(checked_material(), some_cells(40, 2 * t + 1001), 0.02, 2 * t + 1);
    const auto same = gonio::check_conformity(conformity_estimator(), part, reference, noise_of(0.02));
    CHECK(same.directions.size() == 8);
    CHECK(same.predicted() >= 6);
    alike += same.conforms(0.01) ? 1 : 0;
    const auto brighter = noisy(checked_material(), some_cells(8, 2 * t), 0.02, 2 * t, gonio::rgb::Constant(2.0));
    different +=
        gonio::check_conformity(conformity_estimator(), brighter, reference, noise_of(0.02)).conforms(0.01) ? 0 : 1;
  }
  CHECK(alike >= trials - 2);
  CHECK(different >= trials / 2);
}

TEST_CASE("what is shared is compared as if nothing else were there") {
  const auto reference = noisy(checked_material(), some_cells(12, 7), 0.02, 1);
  auto cells = some_cells(12, 7);
  const auto shared = noisy(checked_material(), cells, 0.02, 2);
  auto both = shared;
  const auto more = noisy(checked_material(), some_cells(3, 99), 0.02, 3);
  both.locations.insert(both.locations.end(), more.locations.begin(), more.locations.end());
  both.values.conservativeResize(15, 3);
  both.values.bottomRows(3) = more.values;
  both.weights.conservativeResize(15, both.weights.cols());
  both.weights.bottomRows(3).setOnes();
  const auto alone = gonio::check_conformity(conformity_estimator(), shared, reference, noise_of(0.02));
  const auto together = gonio::check_conformity(conformity_estimator(), both, reference, noise_of(0.02));
  CHECK(together.predicted() == 3);
  CHECK(together.shift_p_value == doctest::Approx(alone.shift_p_value));
  CHECK(together.total_p_value == doctest::Approx(alone.total_p_value));
  CHECK(together.directions[4].p_value == doctest::Approx(alone.directions[4].p_value));
  CHECK(together.directions[13].deviation[0] > 3.0 * together.directions[4].deviation[0]);
}

TEST_CASE("the mirror direction is the same, whatever its phi_d") {
  const auto samples = [](double theta_h, double phi_d, double value) {
    gonio::sample_set all;
    for (const double theta_d : {0.3, 0.8})
      all.push_back({gonio::half_difference{theta_h, theta_d, phi_d}, gonio::rgb::Constant(value), 1.0});
    return gonio::locate_samples(conformity_cells(), all);
  };
  const auto reference = samples(0.0, 0.0, 2.0);
  for (const double theta_h : {0.0, 1e-6})
    for (const double phi_d : {0.0, 0.5, 1.57, 3.1}) {
      CAPTURE(phi_d);
      const auto found =
          gonio::check_conformity(conformity_estimator(), samples(theta_h, phi_d, 3.0), reference, noise_of(0.02));
      CHECK(found.predicted() == 0);
      CHECK_FALSE(found.conforms(0.001));
    }
}

TEST_CASE("a reference that contradicts itself after a swap conforms to itself, a part unlike both does not") {
  // An instrument reads other values after light and viewer are swapped.
  const auto read = [](std::initializer_list<double> values) {
    const gonio::direction one = gonio::spherical_direction(0.35, 0.0), other = gonio::spherical_direction(1.05, 2.0);
    gonio::sample_set all;
    for (const double value : values) {
      const bool is_swapped = all.size() == 1;
      all.push_back({is_swapped ? gonio::direction_pair{other, one} : gonio::direction_pair{one, other},
                     gonio::rgb::Constant(value), 1.0});
    }
    return gonio::locate_samples(conformity_cells(), all);
  };
  const auto p_value = [&](const gonio::located_samples& part, const gonio::located_samples& reference) {
    return gonio::check_conformity(conformity_estimator(), part, reference, noise_of(0.02)).p_value;
  };
  const auto reference = read({0.10, 0.14});
  CHECK(p_value(reference, reference) > 0.01);
  CHECK(p_value(read({0.10}), reference) > 0.01);
  CHECK(p_value(read({0.60}), reference) < 1e-3);
  CHECK(p_value(read({0.10}), read({0.14})) < 1e-3);
}

TEST_CASE("repeats of the reference make it surer, and their order does not matter") {
  const auto part = noisy(checked_material(), {77}, 0.02, 2);
  const auto once = noisy(checked_material(), {77, 300}, 0.02, 1),
             often = noisy(checked_material(), {77, 300, 77, 77}, 0.02, 1);
  const auto by_one = gonio::check_conformity(conformity_estimator(), part, once, noise_of(0.02));
  const auto by_three = gonio::check_conformity(conformity_estimator(), part, often, noise_of(0.02));
  CHECK(by_three.directions[0].measured == 3);
  const double ratio = by_three.directions[0].deviation[1] / by_one.directions[0].deviation[1];
  CHECK(ratio == doctest::Approx(std::sqrt((1.0 + 1.0 / 3.0) / 2.0)).epsilon(0.01));
  const auto reordered =
      gonio::check_conformity(conformity_estimator(), part, often.subset({3, 1, 0, 2}), noise_of(0.02));
  CHECK(reordered.p_value == doctest::Approx(by_three.p_value).epsilon(1e-9));
  // A weight of 2 halves the variance.
  auto heavy = part;
  heavy.weights.setConstant(2.0);
  const auto weighted = gonio::check_conformity(conformity_estimator(), heavy, once, noise_of(0.02));
  CHECK(weighted.directions[0].deviation[1] / by_one.directions[0].deviation[1] ==
        doctest::Approx(std::sqrt(0.75)).epsilon(0.01));
}

TEST_CASE("noise is told by repeats, and none without") {
  std::vector<Eigen::Index> cells;
  for (int repeat = 0; repeat < 30; ++repeat)
    for (const Eigen::Index cell : some_cells(10, 3)) cells.push_back(cell);
  const auto& metric = conformity_estimator().prior().metric();
  const auto found = gonio::noise_of_repeats(metric, noisy(checked_material(), cells, 0.03, 8));
  CHECK(found.degrees_of_freedom == 3.0 * 29.0 * 10.0);
  CHECK(found.relative == doctest::Approx(0.03).epsilon(0.1));
  CHECK(gonio::noise_of_repeats(metric, noisy(checked_material(), some_cells(10, 3), 0.03, 8)).degrees_of_freedom ==
        0.0);
  const auto pooled =
      gonio::pooled_noise({.relative = 0.03, .degrees_of_freedom = 10}, {.relative = 0.05, .degrees_of_freedom = 30});
  CHECK(pooled.degrees_of_freedom == 40.0);
  CHECK(pooled.relative == doctest::Approx(std::sqrt((10 * 0.0009 + 30 * 0.0025) / 40.0)));
}

TEST_CASE("a material of the prior is familiar, values in another order are not") {
  const auto cells = some_cells(20, 11);
  const auto samples = noisy(checked_material(), cells, 0.0, 0);
  const auto known = conformity_estimator().process_of(samples).familiarity();
  CHECK(known.components + known.discrepancy + known.errors == doctest::Approx(1.0));
  CHECK(known.components > 0.0);
  CHECK(known.discrepancy > 0.0);
  CHECK(known.errors > 0.0);
  CHECK(known.p_value > 0.05);
  auto shuffled = samples;
  shuffled.values = samples.values.colwise().reverse().eval();
  const auto strange = conformity_estimator().process_of(shuffled).familiarity();
  CHECK(strange.scale > 5.0 * known.scale);
  CHECK(strange.p_value < known.p_value);
  // y' K^-1 y, computed directly.
  const Eigen::MatrixXd y = conformity_estimator().process_of(samples).values();
  const Eigen::MatrixXd k = conformity_estimator().process_of(samples).covariance();
  CHECK(known.scale == doctest::Approx(y.cwiseProduct(Eigen::MatrixXd(k.llt().solve(y))).sum() / 60.0).epsilon(1e-6));
}

TEST_CASE("negative values count as zero, and values near zero are no evidence by relative noise alone") {
  auto part = noisy(checked_material(), {77, 300}, 0.0, 0);
  auto reference = part;
  part.values(0, 0) = -0.01;
  reference.values(0, 0) = 0.0;
  const auto found = gonio::check_conformity(conformity_estimator(), part, reference, noise_of(0.02));
  CHECK(found.p_value == 1.0);
  reference.values(0, 0) = 0.02;
  CHECK_FALSE(gonio::check_conformity(conformity_estimator(), part, reference, noise_of(0.02)).conforms());
  gonio::conformity_options dark = noise_of(0.02);
  dark.part.dark = dark.reference.dark = 0.02;
  CHECK(gonio::check_conformity(conformity_estimator(), part, reference, dark).conforms());
}

TEST_CASE("impossible options and samples are refused") {
  const auto samples = noisy(checked_material(), {77, 300}, 0.0, 0);
  const auto refused = [&](const gonio::conformity_options& options, std::initializer_list<std::string> words) {
    scratch::check_refused([&] { return gonio::check_conformity(conformity_estimator(), samples, samples, options); },
                           words);
  };
  refused({.part = {-0.1}}, {"noise", "0 to 0.3"});
  refused({.part = {0.5}}, {"noise", "0 to 0.3"});
  refused({.part = {std::nan("")}}, {"noise"});
  refused({.part = {.relative = 0.1, .dark = -1.0}}, {"noise"});
  refused({.reference = {0.1}}, {"noise of the part's measurement", "above 0"});
  refused({.part = {.relative = 0.1, .degrees_of_freedom = 0.0}}, {"degrees of freedom above 0"});
  refused({.part = {0.1}, .tolerance = {-1.0}}, {"tolerance", "not negative"});
  refused({.part = {0.1}, .tolerance = {0.1, 0.2}}, {"expected one tolerance, or one for each of 3 channels, not 2"});
  refused({.part = {0.1}, .peak_tolerance = -0.1}, {"tolerance", "not negative"});
  refused({.part = {0.1}, .tolerance = {0.1}, .delta_e = 1.0}, {"a Delta E tolerance cannot be combined"});
  refused({.part = {0.1}, .same_direction = 1.0}, {"radians"});
  gonio::located_samples grey = samples;
  grey.values.colwise() = samples.values.col(0).eval();
  scratch::check_refused(
      [&] { return gonio::check_conformity(conformity_estimator(), grey, grey, {.part = {0.1}, .delta_e = 1.0}); },
      {"a Delta E tolerance needs part and reference in RGB"});
  const auto many = noisy(checked_material(), std::vector<Eigen::Index>(2501, 77), 0.0, 0);
  scratch::check_refused([&] { return gonio::check_conformity(conformity_estimator(), many, samples, noise_of(0.1)); },
                         {"at most 2500", "2501"});
  scratch::check_refused(
      [&] { return gonio::check_conformity(conformity_estimator(), gonio::located_samples{}, samples, noise_of(0.1)); },
      {"at least one sample"});
}

TEST_CASE("repeats are sought among few samples") {
  const auto many = noisy(checked_material(), std::vector<Eigen::Index>(5001, 77), 0.0, 0);
  scratch::check_refused([&] { return gonio::noise_of_repeats(conformity_estimator().prior().metric(), many); },
                         {"at most 5000", "5001"});
}

TEST_CASE("a noiseless reference predicts, even if it is repeated in a direction") {
  const auto part = noisy(checked_material(), {300}, 0.0, 0);
  const auto by = [&](const std::vector<Eigen::Index>& cells) {
    return gonio::check_conformity(conformity_estimator(), part, noisy(checked_material(), cells, 0.0, 0),
                                   {.part = {0.1}});
  };
  CHECK(by({77, 77}).directions[0].deviation[0] == doctest::Approx(by({77}).directions[0].deviation[0]).epsilon(0.3));
  CHECK(by({77, 77}).conforms());
}

TEST_CASE("channels are data: one reading is one channel, and each of many wavelengths counts") {
  const auto cells = some_cells(12, 4);
  auto part = noisy(checked_material(), cells, 0.02, 1), reference = noisy(checked_material(), cells, 0.02, 2);
  // Three copies of one reading count as one channel.
  for (gonio::located_samples* samples : {&part, &reference})
    samples->values = samples->values.col(0).replicate(1, 3).eval();
  const auto thrice = gonio::check_conformity(conformity_estimator(), part, reference, noise_of(0.02));
  part.values = part.values.leftCols(1).eval();
  reference.values = reference.values.leftCols(1).eval();
  const auto once = gonio::check_conformity(conformity_estimator(), part, reference, noise_of(0.02));
  CHECK(once.shift.size() == 1);
  CHECK(thrice.p_value == once.p_value);
  CHECK(thrice.directions[3].difference.size() == 1);

  // The last of five wavelengths is tripled.
  part.values = part.values.replicate(1, 5).eval();
  reference.values = reference.values.replicate(1, 5).eval();
  part.values.col(4) *= 3.0;
  const auto tripled = gonio::check_conformity(conformity_estimator(), part, reference, noise_of(0.02));
  CHECK(tripled.p_value < 1e-9);
  CHECK(tripled.shift.size() == 5);
  CHECK(std::expm1(tripled.shift[4]) == doctest::Approx(2.0).epsilon(0.1));
  CHECK(std::abs(tripled.shift[0]) < 0.05);
  CHECK(tripled.directions[0].expected[4] == doctest::Approx(reference.values(0, 4)).epsilon(0.1));
  scratch::check_refused(
      [&] {
        auto other = reference;
        other.values = reference.values.leftCols(4).eval();
        return gonio::check_conformity(conformity_estimator(), part, other, noise_of(0.02));
      },
      {"5 channels", "the reference has 4"});
}

TEST_CASE("parts of one channel are refused as seldom as was promised") {
  // 400 pairs at a promised rate of 5 %: within three standard deviations of the binomial distribution.
  for (const Eigen::Index channels : {1, 3, 5}) {
    CAPTURE(channels);
    int refused = 0;
    for (unsigned pair = 0; pair < 400; ++pair) {
      auto part = noisy(checked_material(), {77, 300, 411, 90, 123}, 0.0, 0), reference = part;
      std::mt19937 random(pair);
      std::normal_distribution<double> normal;
      for (gonio::located_samples* samples : {&part, &reference}) {
        Eigen::MatrixXd values = samples->values.col(0).replicate(1, channels);
        for (Eigen::Index i = 0; i < values.rows(); ++i)
          for (Eigen::Index c = 0; c < channels; ++c) values(i, c) *= 1.0 + 0.02 * normal(random);
        samples->values = channels == 1 ? Eigen::MatrixXd(values.replicate(1, 3)) : values;  // as files are read
      }
      refused +=
          gonio::check_conformity(conformity_estimator(), part, reference, noise_of(0.02)).conforms(0.05) ? 0 : 1;
    }
    CHECK(refused <= 33);
    CHECK(refused >= 4);
  }
}
