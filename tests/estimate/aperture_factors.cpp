#include <gonio/estimate/aperture_factors.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using gonio::direction, gonio::radians;

namespace {

/// A lobe around the mirror direction with a standard deviation of 0.5 degrees in theta_h, plus a constant. The second
/// channel is zero.
Eigen::ArrayXd narrow_lobe(const direction& wi, const direction& wo) {
  const double theta_h = gonio::to_half_difference(wi, wo).theta_h / radians(0.5);
  return Eigen::ArrayXd{{0.1 + 100.0 * std::exp(-0.5 * theta_h * theta_h), 0.0, 1.0}};
}

}  // namespace

TEST_CASE("factors of samples around a lobe narrower than the receiver are those of its integral") {
  gonio::sample_set samples;
  std::vector<Eigen::Index> numbers;
  for (double off = -8.0; off <= 8.0; off += 0.25) {
    numbers.push_back(std::ssize(samples));
    samples.push_back({gonio::direction_pair{gonio::spherical_direction(radians(30.0), 0.0),
                                             gonio::spherical_direction(radians(30.0 + off), radians(180.0))},
                       gonio::rgb::Ones(),
                       1.0,
                       {0.0, radians(2.0)}});
  }
  const Eigen::MatrixXd factors = gonio::detail::aperture_factors(samples, numbers, narrow_lobe, {});
  double worst = 0.0;
  for (const Eigen::Index i : numbers) {
    const gonio::direction_pair& axes = samples.directions(i).pair();
    const double mean = gonio::mean_within(axes, samples.aperture(i), 4096, narrow_lobe)[0],
                 exact = std::clamp(mean / narrow_lobe(axes.wi, axes.wo)[0], 0.01, 100.0);
    worst = std::max(worst, std::abs(std::log(factors(i, 0) / exact)));
  }
  CHECK(worst < 0.2);              // measured: 0.099 with 64 pairs a sample, 0.46 with 16
  CHECK(factors.col(1).isOnes());  // zero reflectance
  CHECK(factors.col(2).isOnes(1e-12));
}

TEST_CASE("a single direction has the factor one") {
  gonio::sample_set samples;
  samples.push_back({gonio::direction_pair{{0.0, 0.0, 1.0}, {0.6, 0.0, 0.8}}, gonio::rgb::Ones()});
  CHECK(gonio::detail::aperture_factors(samples, {0}, narrow_lobe, {}).isOnes());
}
