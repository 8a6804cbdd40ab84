#pragma once
/// Order statistics. Each takes a vector or a span of numbers, one at least, none of which is a NaN, and reorders them:
/// hand over a copy of what must stay in order. O(n).

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

namespace gonio {

/// Times the median distance from the median, this is the standard deviation of normal numbers, whatever a few others
/// among them are: 1 over the normal distribution's quantile of 0.75.
inline constexpr double deviation_by_median = 1.4826;

/// Numbers in the order of what belongs to them, and of themselves where that is the same. O(n log n).
[[nodiscard]] inline std::vector<std::ptrdiff_t> in_order(std::vector<std::pair<double, std::ptrdiff_t>> keyed) {
  std::sort(keyed.begin(), keyed.end());
  std::vector<std::ptrdiff_t> ordered;
  for (const auto& [key, number] : keyed) ordered.push_back(number);
  return ordered;
}

/// The number at a position, from 0 on, when they are sorted. The smaller ones are then before it.
template <class Numbers>
[[nodiscard]] auto nth_smallest(Numbers&& numbers, std::ptrdiff_t position) {
  const auto at = std::begin(numbers) + position;
  std::nth_element(std::begin(numbers), at, std::end(numbers));
  return *at;
}

/// The number at floor(share (n - 1)) when they are sorted: the least for a share of 0, the greatest for 1.
template <class Numbers>
[[nodiscard]] auto quantile(Numbers&& numbers, double share) {
  return nth_smallest(numbers, static_cast<std::ptrdiff_t>(share * static_cast<double>(std::size(numbers) - 1)));
}

/// The number in the middle, the upper one of an even number of them.
template <class Numbers>
[[nodiscard]] auto upper_median(Numbers&& numbers) {
  return nth_smallest(numbers, std::ssize(numbers) / 2);
}

/// The number in the middle, or the mean of the two in the middle.
template <class Numbers>
[[nodiscard]] auto median(Numbers&& numbers) {
  const auto upper = upper_median(numbers);
  if (std::size(numbers) % 2 != 0) return upper;
  return (*std::max_element(std::begin(numbers), std::begin(numbers) + std::ssize(numbers) / 2) + upper) / 2;
}

}  // namespace gonio
