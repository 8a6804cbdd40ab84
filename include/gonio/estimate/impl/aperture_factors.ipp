#pragma once
/// Bodies of estimate/aperture_factors.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/estimate/aperture_factors.hpp>

#include <algorithm>
#include <functional>
#include <vector>

namespace gonio::detail {

GONIO_INLINE Eigen::MatrixXd aperture_factors(
    const sample_set& samples, const std::vector<Eigen::Index>& numbers,
    const std::function<Eigen::ArrayXd(const direction& wi, const direction& wo)>& values, thread_count threads) {
  constexpr int pairs_a_sample = 64;  // with 16, similar samples hit or miss a narrow lobe by chance
  constexpr double most = 100.0;
  Eigen::MatrixXd factors = Eigen::MatrixXd::Ones(numbers.size(), samples.channels().size());
  for_each_index(
      numbers.size(), 16,
      [&](Eigen::Index i) {
        const Eigen::Index number = numbers[i];
        if (samples.aperture(number).is_point()) return;
        const direction_pair& axes = samples.directions(number).pair();
        const Eigen::ArrayXd middle = values(axes.wi, axes.wo);
        const Eigen::ArrayXd mean = mean_within(axes, samples.aperture(number), pairs_a_sample, values);
        for (Eigen::Index c = 0; c < factors.cols(); ++c)
          if (mean[c] > 0.0 && middle[c] > 0.0) factors(i, c) = std::clamp(mean[c] / middle[c], 1.0 / most, most);
      },
      threads);
  return factors;
}

}  // namespace gonio::detail
