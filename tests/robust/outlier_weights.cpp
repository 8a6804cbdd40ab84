#include "tukey_weights.hpp"
#include <gonio/robust/outlier_weights.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

using gonio::channel_values;

namespace {

/// The smallest model, from the concept's documentation.
struct user_made_trust {
  channel_values weigh(const channel_values& measured, const channel_values&) const {
    return channel_values::Ones(3, measured.cols());
  }
};
static_assert(gonio::outlier_weighting<user_made_trust>);

struct no_weighting {
  int weigh(const channel_values&, const channel_values&) const { return 1; }
};
static_assert(!gonio::outlier_weighting<no_weighting>);

/// Returns reflectances from 1e-4 to 1e2, and occasionally zero.
channel_values any_reflectances(Eigen::Index count) {
  channel_values values(3, count);
  for (float& value : values.reshaped()) {
    const int number = *rc::gen::inRange(0, 1001);
    value = number == 0 ? 0.0f : static_cast<float>(1e-4 * std::pow(10.0, 6e-3 * number));
  }
  return values;
}

channel_values row_in_each_channel(std::initializer_list<float> values) {
  channel_values all(3, std::ssize(values));
  Eigen::Index i = 0;
  for (const float value : values) all.col(i++).setConstant(value);
  return all;
}

}  // namespace

TEST_CASE("equal_weights: 1 for each channel of each sample") {
  const auto values = row_in_each_channel({1, 2, -3, 0});
  CHECK((gonio::equal_weights{}.weigh(values, values) == 1.0f).all());
  CHECK(gonio::equal_weights{}.weigh(values, values).cols() == 4);
}

TEST_CASE("relative deviation: Eq. 13 by hand") {
  const auto measured = row_in_each_channel({1.0f, 1.5f, 0.5f, 3.0f, 0.0f, -1.0f, 0.0f, 1e-6f});
  const auto estimated = row_in_each_channel({1.0f, 1.0f, 1.0f, 1.0f, 2.0f, 1.0f, 0.0f, 0.0f});
  const auto weights = gonio::relative_deviation_weights{3.0}.weigh(measured, estimated);
  const double exponents[] = {0.0, -1.5, -1.5, -6.0, -3.0, -6.0, -3.0, 0.0};  // the last two: at the least, 1e-6
  for (Eigen::Index i = 0; i < 8; ++i)
    for (Eigen::Index c = 0; c < 3; ++c)
      CHECK(double{weights(c, i)} == doctest::Approx(std::exp(exponents[i])).epsilon(1e-6));
  CHECK((gonio::relative_deviation_weights{0.0}.weigh(measured, estimated) == 1.0f).all());
}

TEST_CASE("relative deviation: from 0 to 1, and at least e^-gamma where the estimate is above the measurement") {
  CHECK(rc::check([] {
    const double gamma = 0.1 * *rc::gen::inRange(0, 100);
    const auto measured = any_reflectances(5), estimated = any_reflectances(5);
    const auto weights = gonio::relative_deviation_weights{gamma}.weigh(measured, estimated);
    for (Eigen::Index i = 0; i < weights.size(); ++i) {
      const float weight = weights.reshaped()[i];
      RC_ASSERT(weight >= 0.0f);
      RC_ASSERT(weight <= 1.0f);
      if (estimated.reshaped()[i] >= measured.reshaped()[i])
        RC_ASSERT(weight >= static_cast<float>(std::exp(-gamma)) * (1 - 1e-6f));
    }
  }));
}

TEST_CASE("relative deviation: weights fall as measurements go away, to zero far out, and stay finite") {
  const auto estimated = row_in_each_channel({0.1f, 0.1f, 0.1f, 0.1f, 0.0f});
  const auto measured = row_in_each_channel({0.1f, 0.2f, 0.4f, 1e30f, 1e38f});
  const auto weights = gonio::relative_deviation_weights{}.weigh(measured, estimated);
  CHECK(weights(0, 0) == 1.0f);
  CHECK(weights(0, 1) < weights(0, 0));
  CHECK(weights(0, 2) < weights(0, 1));
  CHECK(weights(0, 3) == 0.0f);
  CHECK(weights(0, 4) == 0.0f);
}

TEST_CASE("tukey: by hand") {
  // The logarithmic deviations 0, 0.1, 0.2, 0.3, 10 have the median 0.2, so the limit is 4.685 x 1.4826 x 0.2 = 1.3892.
  std::initializer_list<double> deviations = {0.0, 0.1, -0.2, 0.3, 10.0};
  channel_values measured(3, 5), estimated = channel_values::Constant(3, 5, 0.5f);
  Eigen::Index i = 0;
  for (const double deviation : deviations)
    measured.col(i++).setConstant(static_cast<float>(std::exp(std::log(0.501) + deviation) - 1e-3));
  const auto weights = gonio::tukey_weights{}.weigh(measured, estimated);
  i = 0;
  for (const double deviation : deviations) {
    const double u = deviation / (4.685 * 1.4826 * 0.2);
    const double expected = std::abs(u) < 1.0 ? std::pow(1.0 - u * u, 2) : 0.0;
    for (Eigen::Index c = 0; c < 3; ++c) CHECK(double{weights(c, i)} == doctest::Approx(expected).epsilon(1e-5));
    ++i;
  }
  CHECK(weights(0, 0) == 1.0f);
  CHECK(weights(2, 4) == 0.0f);
}

TEST_CASE("tukey: channels are judged by themselves, from 0 to 1, and only relative deviations count") {
  CHECK(rc::check([] {
    const Eigen::Index count = *rc::gen::inRange(1, 30);
    const auto measured = any_reflectances(count), estimated = any_reflectances(count);
    const gonio::tukey_weights tukey{4.685, 0.0f};
    // Without the offset, zero has no logarithm.
    const channel_values m = measured.max(1e-4f), e = estimated.max(1e-4f);
    const auto weights = tukey.weigh(m, e);
    RC_ASSERT((weights >= 0.0f && weights <= 1.0f).all());
    // Squaring doubles all logarithmic deviations and their median.
    const auto squared = tukey.weigh(m.square(), e.square());
    RC_ASSERT(((squared - weights).abs() <= 2e-4f).all());
    // A common brightness factor changes nothing.
    const auto brighter = tukey.weigh(8.0f * m, 8.0f * e);
    RC_ASSERT(((brighter - weights).abs() <= 2e-4f).all());
    // Changing green changes neither red nor blue.
    channel_values other = m;
    other.row(1) = other.row(1).reverse().eval() + 1.0f;
    const auto changed = tukey.weigh(other, e);
    RC_ASSERT((changed.row(0) == weights.row(0)).all());
    RC_ASSERT((changed.row(2) == weights.row(2)).all());
    // At least half of the samples are inliers: the median is 1 / 6.9 of the limit.
    RC_ASSERT((weights.row(0) > 0.9f).count() >= (count + 1) / 2);
  }));
}

TEST_CASE("tukey: all samples of a perfect fit have full weight, and a single deviation has none") {
  auto measured = row_in_each_channel({1, 2, 3, 4, 5});
  const auto estimated = measured;
  CHECK((gonio::tukey_weights{}.weigh(measured, estimated) == 1.0f).all());
  measured(1, 3) = 4.1f;
  const auto weights = gonio::tukey_weights{}.weigh(measured, estimated);
  CHECK(weights(1, 3) == 0.0f);
  CHECK(weights.sum() == 14.0f);
  // Zeros and negative measurements agree perfectly with an estimate of zero.
  CHECK((gonio::tukey_weights{}.weigh(row_in_each_channel({0, -1}), row_in_each_channel({0, 0})) == 1.0f).all());
}
