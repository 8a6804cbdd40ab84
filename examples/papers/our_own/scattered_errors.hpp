#pragma once
/// Errors of an estimate against measurements in arbitrary directions.

#include <gonio/core/direction.hpp>
#include <gonio/core/rgb.hpp>

#include <algorithm>
#include <cmath>

namespace papers {

/// Root mean square difference of ln(f + 0.001) over all values of all channels. Negative values count as zero.
class logarithmic_error {
 public:
  void add(const gonio::rgb& estimate, const gonio::rgb& truth) {
    constexpr double offset = 1e-3;
    sum_ += ((estimate.max(0.0) + offset) / (truth.max(0.0) + offset)).log().square().sum();
    count_ += 3.0;
  }
  [[nodiscard]] double value() const { return std::sqrt(sum_ / count_); }

 private:
  double sum_ = 0.0, count_ = 0.0;
};

/// Square root of the ratio of two sums of squares over all channels: of (estimate - truth) cos_i cos_o, and of truth
/// cos_i cos_o. A black estimate has an error of 1.
class cosine_weighted_error {
 public:
  void add(const gonio::rgb& estimate, const gonio::rgb& truth, const gonio::direction_pair& pair) {
    const double weight = std::max(pair.wi.z(), 0.0) * std::max(pair.wo.z(), 0.0);
    missed_ += ((estimate - truth) * weight).square().sum();
    all_ += (truth * weight).square().sum();
  }
  [[nodiscard]] double value() const { return std::sqrt(missed_ / all_); }

 private:
  double missed_ = 0.0, all_ = 0.0;
};

}  // namespace papers
