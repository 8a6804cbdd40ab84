#pragma once
/// Spearman's rank correlation: whether two quantities increase together.

#include <Eigen/Core>

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace papers {

/// Returns the rank of each value, from 0.
[[nodiscard]] inline Eigen::ArrayXd ranks_of(std::span<const double> values) {
  std::vector<Eigen::Index> order(values.size());
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::ranges::sort(order, {}, [&](Eigen::Index i) { return std::pair(values[i], i); });
  Eigen::ArrayXd ranks(std::ssize(values));
  for (Eigen::Index rank = 0; rank < ranks.size(); ++rank) ranks[order[rank]] = static_cast<double>(rank);
  return ranks;
}

/// Returns Spearman's rank correlation of at least two pairs of values: 1 if both increase together, 0 if they are
/// unrelated. Equal values are ranked in their order.
[[nodiscard]] inline double rank_correlation(std::span<const double> a, std::span<const double> b) {
  const Eigen::ArrayXd left = ranks_of(a) - 0.5 * static_cast<double>(a.size() - 1);
  const Eigen::ArrayXd right = ranks_of(b) - 0.5 * static_cast<double>(b.size() - 1);
  return (left * right).sum() / left.square().sum();
}

}  // namespace papers
