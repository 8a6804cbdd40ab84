#pragma once
/// Samples grouped by the angles of their half and difference vectors: whatever goes wrong in a measurement does so in
/// all directions alike, but a fit may be good for the diffuse part of a surface and bad in its highlight.

#include <gonio/table/location.hpp>

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

namespace gonio {

/// At most six strips of theta_h with equal numbers of samples, each cut into at most four parts of theta_d: as many as
/// leave eight samples in each. With fewer in a region chance decides; with more, few samples have but one.
class sample_regions {
 public:
  static constexpr std::size_t fewest_samples = 8;

  /// O(n log n).
  explicit sample_regions(const std::vector<location>& locations);

  [[nodiscard]] std::size_t count() const noexcept { return strips_ * parts_; }

  /// The positions of all samples.
  [[nodiscard]] std::span<const std::size_t> all() const noexcept { return order_; }
  /// Those of one region; the first regions are nearest to the highlight.
  [[nodiscard]] std::span<const std::size_t> operator[](std::size_t region) const noexcept {
    return part_of<const std::size_t>(part_of<const std::size_t>(order_, region / parts_, strips_), region % parts_,
                                      parts_);
  }

 private:
  [[nodiscard]] static std::size_t at_most(std::size_t most, std::size_t samples) noexcept {
    return std::clamp<std::size_t>(samples / fewest_samples, 1, most);
  }

  template <class Position>
  [[nodiscard]] static std::span<Position> part_of(std::span<Position> whole, std::size_t part,
                                                   std::size_t parts) noexcept {
    const std::size_t begin = whole.size() * part / parts, end = whole.size() * (part + 1) / parts;
    return whole.subspan(begin, end - begin);
  }

  std::vector<std::size_t> order_;
  std::size_t strips_, parts_;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/sample_regions.ipp>
#endif
