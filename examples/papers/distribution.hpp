#pragma once
/// Summary statistics over many reconstructions.

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

namespace papers {

/// Mean, median and worst of at least one value.
struct distribution {
  double mean = 0.0, median = 0.0, worst = 0.0;

  explicit distribution(std::span<const double> values) {
    std::vector<double> sorted(values.begin(), values.end());
    std::ranges::sort(sorted);
    mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    median = (sorted[sorted.size() / 2] + sorted[(sorted.size() - 1) / 2]) / 2.0;
    worst = sorted.back();
  }
};

}  // namespace papers
