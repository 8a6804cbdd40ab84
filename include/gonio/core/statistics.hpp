#pragma once
/// Order statistics. Each function except `in_order` takes a vector or a span of at least one number, none of them NaN,
/// and reorders it: pass a copy if the order matters. O(n).

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

namespace gonio {

/// 1 over the 0.75 quantile of the normal distribution. The median distance of normal numbers from their median, times
/// this factor, is their standard deviation, regardless of a few outliers.
inline constexpr double deviation_by_median = 1.4826;

/// Returns numbers in the order of their keys; for equal keys, in their own order. O(n log n).
[[nodiscard]] inline std::vector<std::ptrdiff_t> in_order(std::vector<std::pair<double, std::ptrdiff_t>> keyed) {
  std::sort(keyed.begin(), keyed.end());
  std::vector<std::ptrdiff_t> ordered;
  for (const auto& [key, number] : keyed) ordered.push_back(number);
  return ordered;
}

/// Returns the number at a position, counted from 0, in sorted order. Moves smaller numbers before that position.
template <class Numbers>
[[nodiscard]] auto nth_smallest(Numbers&& numbers, std::ptrdiff_t position) {
  const auto at = std::begin(numbers) + position;
  std::nth_element(std::begin(numbers), at, std::end(numbers));
  return *at;
}

/// Returns the number at floor(share (n - 1)) in sorted order: the smallest for a share of 0, the largest for 1.
template <class Numbers>
[[nodiscard]] auto quantile(Numbers&& numbers, double share) {
  return nth_smallest(numbers, static_cast<std::ptrdiff_t>(share * static_cast<double>(std::size(numbers) - 1)));
}

/// Returns the middle number, or the upper of the two middle numbers.
template <class Numbers>
[[nodiscard]] auto upper_median(Numbers&& numbers) {
  return nth_smallest(numbers, std::ssize(numbers) / 2);
}

/// Returns the middle number, or the mean of the two middle numbers.
template <class Numbers>
[[nodiscard]] auto median(Numbers&& numbers) {
  const auto upper = upper_median(numbers);
  if (std::size(numbers) % 2 != 0) return upper;
  return (*std::max_element(std::begin(numbers), std::begin(numbers) + std::ssize(numbers) / 2) + upper) / 2;
}

}  // namespace gonio
