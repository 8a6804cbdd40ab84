#pragma once
/// Samples grouped by the angle between the half vector and the normal: whatever goes wrong in a measurement does so in
/// all directions alike, but a fit may be good for the diffuse part of a surface and bad in its highlight.

#include <gonio/table/location.hpp>

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

namespace gonio {

/// At most eight regions of theta_h with equal numbers of samples, at least a hundred in each if there are more than
/// one.
class sample_regions {
 public:
  /// O(n log n).
  explicit sample_regions(const std::vector<location>& places)
      : order_(places.size()), count_(std::clamp<std::size_t>(places.size() / 100, 1, 8)) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::ranges::sort(order_, [&](std::size_t one, std::size_t other) {
      const double first = places[one].angles.theta_h, second = places[other].angles.theta_h;
      return first != second ? first < second : one < other;
    });
  }

  [[nodiscard]] std::size_t count() const noexcept { return count_; }

  /// The positions of all samples, and of those of one region; the first region is nearest to the highlight.
  [[nodiscard]] std::span<const std::size_t> all() const noexcept { return order_; }
  [[nodiscard]] std::span<const std::size_t> operator[](std::size_t region) const noexcept {
    const std::size_t begin = order_.size() * region / count_, end = order_.size() * (region + 1) / count_;
    return all().subspan(begin, end - begin);
  }

 private:
  std::vector<std::size_t> order_;
  std::size_t count_;
};

}  // namespace gonio
