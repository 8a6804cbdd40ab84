#include <gonio/estimate/outlier_mixture.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <random>
#include <utility>

using gonio::automatic_weights;
using gonio::channel_values;
using gonio::outlier_density;
using gonio::outlier_mixture;

namespace {

std::vector<double> uniform_numbers(std::size_t count, double low, double high, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform(low, high);
  std::vector<double> numbers(count);
  for (double& number : numbers) number = uniform(generator);
  return numbers;
}

/// Returns the integral of a density from low to high by the midpoint rule.
template <class Density>
double integral(const Density& density, double low, double high, int steps = 40'000) {
  const double width = (high - low) / steps;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) sum += width * density(low + (i + 0.5) * width);
  return sum;
}

/// Reflectances of a synthetic material and an estimate of it. Most are diffuse, a few per cent are a highlight. A
/// fraction `share` of the measurements, none in the highlight, are those of other locations.
struct synthetic_measurement {
  channel_values measured, estimated;
  std::vector<bool> outlier;
};

synthetic_measurement synthetic_measurement_of(Eigen::Index count, double share, double scale, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform;
  std::normal_distribution<double> normal;
  synthetic_measurement all{channel_values(3, count), channel_values(3, count), {}};
  const auto reflectance = [&] { return 0.05 * std::exp(3.0 * std::pow(uniform(generator), 2)); };
  for (Eigen::Index i = 0; i < count; ++i) {
    const double truth = reflectance();
    all.outlier.push_back(uniform(generator) < share);
    const double value = all.outlier.back() ? reflectance() : truth * std::exp(scale * normal(generator));
    all.measured.col(i).setConstant(static_cast<float>(value));
    all.estimated.col(i).setConstant(static_cast<float>(truth));
  }
  return all;
}

}  // namespace

TEST_CASE("the density of outliers is positive and integrates to 1") {
  CHECK(rc::check([] {
    const std::size_t count = *rc::gen::inRange(1, 300);
    const double width = std::pow(10.0, *rc::gen::inRange(-3, 2));
    const auto logarithms = uniform_numbers(count, -5.0, -5.0 + width, static_cast<unsigned>(count));
    const outlier_density density(logarithms);
    const auto [least, most] = std::ranges::minmax_element(logarithms);
    // The support extends half a unit past the measurements, in 200 constant bins. The rule is exact except for 1 in
    // 200 steps.
    const double whole = integral(density, *least - 0.5, *most + 0.5);
    RC_ASSERT(std::abs(whole - 1.0) < 1e-6);
    for (const double value : logarithms) RC_ASSERT(density(value) > 0.0);
    RC_ASSERT(density(*least - 100.0) > 0.0);  // the outermost bins extend to infinity
    RC_ASSERT(density(*most + 100.0) > 0.0);
  }));
}

TEST_CASE("the density of outliers is higher where more was measured, but flatter than the measurements'") {
  auto logarithms = uniform_numbers(9000, 0.0, 1.0, 1);
  const auto few = uniform_numbers(1000, 3.0, 4.0, 2);
  logarithms.insert(logarithms.end(), few.begin(), few.end());
  const outlier_density density(logarithms);
  const double ratio = density(0.5) / density(3.5);
  // Nine times as many measurements give three times the density, by the square root.
  CHECK(ratio == doctest::Approx(3.0).epsilon(0.05));
  CHECK(density(2.0) < density(3.5));
  CHECK(density(2.0) > 0.0);
}

TEST_CASE("all measurements equal, one, and two") {
  const outlier_density equal(std::vector<double>(50, -2.0)), one({-2.0}), two({-2.0, 3.0});
  CHECK(integral(equal, -2.5, -1.5) == doctest::Approx(1.0).epsilon(1e-6));
  CHECK(integral(one, -2.5, -1.5) == doctest::Approx(1.0).epsilon(1e-6));
  CHECK(integral(two, -2.5, 3.5) == doctest::Approx(1.0).epsilon(1e-6));
  CHECK(equal(-2.0) > equal(-1.6));
  CHECK(two(-2.0) == doctest::Approx(two(3.0)).epsilon(0.05));
}

TEST_CASE("Student's t: the density of inlier residuals integrates to 1 and has the right tail") {
  for (const double scale : {0.02, 0.3, 2.0}) {
    const outlier_mixture mixture{0.8, scale};
    // Outside 100 scales, a probability of 3.75 / 100^4 is missing on each side.
    CHECK(integral([&](double r) { return mixture.inlier_density(r); }, -100 * scale, 100 * scale) ==
          doctest::Approx(1.0).epsilon(1e-6));
    CHECK(mixture.inlier_density(0.0) == doctest::Approx(0.375 / scale));
    CHECK(mixture.inlier_density(2 * scale) == doctest::Approx(0.375 / scale / std::pow(2.0, 2.5)));
    CHECK(mixture.tail_weight(0.0) == 1.0);
    CHECK(mixture.tail_weight(2 * scale) == doctest::Approx(0.5));
  }
}

TEST_CASE("probabilities are from 0 to 1, fall with the residual, and with the density of outliers") {
  CHECK(rc::check([] {
    const outlier_mixture mixture{1e-3 * *rc::gen::inRange(20, 1000), 1e-2 * *rc::gen::inRange(1, 200)};
    const double residual = 1e-2 * *rc::gen::inRange(0, 2000), outliers = 1e-3 * *rc::gen::inRange(1, 2000);
    const double probability = mixture.probability(residual, outliers);
    RC_ASSERT(probability >= 0.0);
    RC_ASSERT(probability <= 1.0);
    RC_ASSERT(mixture.probability(-residual, outliers) == probability);
    RC_ASSERT(mixture.probability(residual + 0.1, outliers) < probability);
    RC_ASSERT(mixture.probability(residual, 1.1 * outliers) < probability);
    RC_ASSERT(mixture.tail_weight(residual) > 0.0);
    RC_ASSERT(mixture.tail_weight(residual) <= 1.0);
  }));
}

TEST_CASE("expectation-maximisation finds the share and the scale that residuals were made with") {
  std::mt19937_64 generator(20);
  std::student_t_distribution<double> student(outlier_mixture::degrees_of_freedom);
  std::uniform_real_distribution<double> uniform(-4.0, 4.0);
  constexpr std::size_t n = 20'000;
  for (const double share : {0.5, 0.8, 0.97})
    for (const double scale : {0.05, 0.3}) {
      std::vector<double> residuals(n);
      for (std::size_t i = 0; i < n; ++i)
        residuals[i] =
            static_cast<double>(i) < share * static_cast<double>(n) ? scale * student(generator) : uniform(generator);
      const std::vector<double> outliers(n, 0.125);  // the density of the uniform outliers
      const auto found = gonio::estimate_mixture(residuals, outliers);
      CAPTURE(share);
      CAPTURE(scale);
      // The standard error of the inlier fraction is a few tenths of a per cent; that of the scale is a fraction of
      // about 1 / sqrt(n), or 1 %. The last EM step changes them by less than 1e-4 and 1e-3, perhaps a tenth of the
      // remaining error.
      CHECK(found.inlier_fraction == doctest::Approx(share).epsilon(0.01));
      CHECK(found.scale == doctest::Approx(scale).epsilon(0.04));
    }
}

TEST_CASE("the mixture's limits: perfect residuals, no inlier, and a start at the solution") {
  const std::vector<double> outliers(100, 0.2);
  const auto perfect = gonio::estimate_mixture(std::vector<double>(100, 0.0), outliers);
  CHECK(perfect.scale == 0.01);
  CHECK(perfect.inlier_fraction == 0.999);
  const auto hopeless = gonio::estimate_mixture(uniform_numbers(100, 50.0, 60.0, 3), outliers);
  CHECK(hopeless.inlier_fraction >= 0.02);
  CHECK(std::isfinite(hopeless.scale));
  // If all n are wrong, p^1 (1 - p)^n is largest at p = 1 / (n + 1).
  const auto nine = gonio::estimate_mixture(std::vector<double>(9, 1e6), std::vector<double>(9, 0.2));
  CHECK(nine.inlier_fraction == doctest::Approx(0.1).epsilon(0.01));
  const auto one = gonio::estimate_mixture({0.7}, {1.0});
  CHECK(std::isfinite(one.scale));
  CHECK(one.inlier_fraction <= 0.999);
}

TEST_CASE("automatic weights tell outliers from inliers") {
  const auto made = synthetic_measurement_of(4000, 0.3, 0.03, 5);
  const auto mixture = automatic_weights{}.mixture(made.measured, made.estimated);
  // 1 - 0.3, with a standard error of 0.7 %. A few per cent of the outliers have the right value by chance.
  CHECK(mixture.inlier_fraction > 0.69);
  CHECK(mixture.inlier_fraction < 0.80);
  CHECK(mixture.scale == doctest::Approx(0.03).epsilon(0.25));  // inlier residuals are Gaussian, not Student's t
  const auto weights = automatic_weights{}.weigh(made.measured, made.estimated);
  CHECK(((weights >= 0.0f) && (weights <= 1.0f)).all());
  CHECK((weights.row(0) == weights.row(1)).all());
  CHECK((weights.row(0) == weights.row(2)).all());
  double inliers = 0.0, outliers = 0.0;
  const auto outlier_count = static_cast<double>(std::ranges::count(made.outlier, true));
  for (std::size_t i = 0; i < made.outlier.size(); ++i) (made.outlier[i] ? outliers : inliers) += double{weights(0, i)};
  CHECK(inliers / (4000.0 - outlier_count) > 0.75);  // the tail weight is 0.8 on average
  CHECK(outliers / outlier_count < 0.15);
  // Without the tail weight, inliers have nearly full weight.
  const auto whole = automatic_weights{.down_weight_tail = false}.weigh(made.measured, made.estimated);
  CHECK((whole >= weights).all());
  double whole_inliers = 0.0;
  for (std::size_t i = 0; i < made.outlier.size(); ++i)
    if (!made.outlier[i]) whole_inliers += double{whole(0, i)};
  CHECK(whole_inliers / (4000.0 - outlier_count) > 0.95);
}

TEST_CASE("automatic weights do not depend on the order of the channels") {
  auto made = synthetic_measurement_of(3000, 0.3, 0.1, 7);
  // Red is constant and carries no information. Green and blue differ.
  made.measured.row(0).setConstant(0.2f);
  made.estimated.row(0).setConstant(0.2f);
  made.measured.row(1) = made.measured.row(1).square();
  made.estimated.row(1) = made.estimated.row(1).square();
  channel_values measured = made.measured, estimated = made.estimated;
  for (const auto& [to, from] : {std::pair{0, 1}, std::pair{1, 2}, std::pair{2, 0}}) {
    measured.row(to) = made.measured.row(from);
    estimated.row(to) = made.estimated.row(from);
  }
  const auto one = automatic_weights{}.weigh(made.measured, made.estimated),
             other = automatic_weights{}.weigh(measured, estimated);
  CHECK((one - other).abs().mean() < 1e-3f);
}

TEST_CASE("a highlight is trusted more than the same residual at a common value") {
  auto made = synthetic_measurement_of(2000, 0.3, 0.1, 6);
  // The last two samples have the same relative error; the value of one is far from all others.
  made.measured.col(1998).setConstant(0.05f);
  made.measured.col(1999).setConstant(50.0f);
  made.estimated.col(1998).setConstant(0.05f * 1.6f);
  made.estimated.col(1999).setConstant(50.0f * 1.6f);
  const auto weights = automatic_weights{.down_weight_tail = false}.weigh(made.measured, made.estimated);
  CHECK(weights(0, 1999) > 2.0f * weights(0, 1998));
  CHECK(weights(0, 1999) > 0.5f);
}

TEST_CASE("offsets are a hundredth of the median of each channel, and at least 1e-4") {
  channel_values measured(3, 3);
  measured << 0.5f, 90.0f, 0.1f,  //
      0.0f, 0.001f, 7.0f,         //
      -5.0f, -1.0f, 3.0f;
  const auto offsets = automatic_weights::offsets(measured);
  CHECK(double{offsets[0]} == doctest::Approx(0.005));
  CHECK(double{offsets[1]} == doctest::Approx(1e-4));
  CHECK(double{offsets[2]} == doctest::Approx(1e-4));
}

TEST_CASE("automatic weights of awkward measurements are from 0 to 1") {
  const auto check = [](const channel_values& measured, const channel_values& estimated) {
    for (const bool tail : {false, true}) {
      const auto weights = automatic_weights{.down_weight_tail = tail}.weigh(measured, estimated);
      REQUIRE(weights.cols() == measured.cols());
      CHECK(((weights >= 0.0f) && (weights <= 1.0f)).all());
    }
  };
  for (const Eigen::Index count : {1, 2, 3, 1000}) {
    const channel_values zero = channel_values::Zero(3, count), half = channel_values::Constant(3, count, 0.5f),
                         huge = channel_values::Constant(3, count, 1e38f),
                         negative = channel_values::Constant(3, count, -4.0f),
                         random = channel_values::Random(3, count);
    for (const channel_values& measured : {zero, half, huge, negative, random})
      for (const channel_values& estimated : {zero, half, huge}) check(measured, estimated);
  }
  // A perfect fit of equal measurements. Outliers would look the same, but all weights are equal and above one half.
  const channel_values half = channel_values::Constant(3, 10, 0.5f);
  const auto weights = automatic_weights{}.weigh(half, half);
  CAPTURE(weights(0, 0));
  CHECK((weights == weights(0, 0)).all());
  CHECK(weights(0, 0) > 0.5f);
}

TEST_CASE("more than twenty thousand measurements are judged by some of them") {
  const auto made = synthetic_measurement_of(50'000, 0.3, 0.03, 8);
  const auto weights = automatic_weights{}.weigh(made.measured, made.estimated);
  REQUIRE(weights.cols() == 50'000);
  const auto few = synthetic_measurement_of(20'000, 0.3, 0.03, 9);
  const auto one = automatic_weights{}.mixture(made.measured, made.estimated);
  const auto other = automatic_weights{}.mixture(few.measured, few.estimated);
  CHECK(one.inlier_fraction == doctest::Approx(other.inlier_fraction).epsilon(0.03));  // five standard errors of 17,000
  CHECK(one.scale == doctest::Approx(other.scale).epsilon(0.05));
}

namespace {

/// Four thousand samples, 30 % of them outliers. An eighth are in a highlight, which the estimate misses by `factor`.
struct missed_highlight {
  synthetic_measurement made = synthetic_measurement_of(4000, 0.3, 0.03, 12);
  std::shared_ptr<const gonio::sample_regions> regions;

  explicit missed_highlight(float factor) {
    std::vector<gonio::location> locations(4000);
    for (std::size_t i = 0; i < 4000; ++i) locations[i].angles.theta_h = 1e-4 * static_cast<double>(i);
    regions = std::make_shared<const gonio::sample_regions>(locations);
    for (Eigen::Index i = 0; i < 500; ++i) {
      made.estimated.col(i) *= 30.0f * factor;
      if (!made.outlier[i]) made.measured.col(i) *= 30.0f;
    }
  }

  /// Returns the mean weight of inliers, or of outliers, in the highlight.
  [[nodiscard]] double weight(const automatic_weights& weighting, bool of_outliers) const {
    const channel_values weights = weighting.weigh(made.measured, made.estimated);
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < 500; ++i)
      if (made.outlier[i] == of_outliers) {
        sum += double{weights(0, i)};
        count += 1.0;
      }
    return sum / count;
  }
};

}  // namespace

TEST_CASE("regions: a highlight that is off by a factor of two is not taken for outliers") {
  const missed_highlight missed(2.0f);
  const automatic_weights pooled, regional{.regions = missed.regions};
  CHECK(missed.weight(pooled, false) < 0.05);
  CHECK(missed.weight(regional, false) > 0.5);
  CHECK(missed.weight(regional, true) < 0.1);
}

TEST_CASE("regions: where a fit is good everywhere they hardly matter") {
  const missed_highlight found(1.0f);
  const automatic_weights pooled, regional{.regions = found.regions};
  CHECK(found.weight(regional, false) == doctest::Approx(found.weight(pooled, false)).epsilon(0.1));
  const channel_values one = pooled.weigh(found.made.measured, found.made.estimated),
                       other = regional.weigh(found.made.measured, found.made.estimated);
  CHECK((one - other).abs().mean() < 0.05f);
  CHECK(((other >= 0.0f) && (other <= 1.0f)).all());
}
