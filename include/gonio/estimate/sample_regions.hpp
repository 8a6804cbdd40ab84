#pragma once
/// Samples grouped by half and difference angles. Measurement errors are alike in all directions, but a fit may be good
/// in the diffuse part of a surface and bad in its highlight.

#include <gonio/table/location.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

namespace gonio {

/// Regions of samples: at most six strips of theta_h with equal numbers of samples, each cut into at most four parts of
/// theta_d. If there are at least eight samples, each region has at least eight. In smaller regions, the scale of
/// residuals would be a matter of chance; with larger regions, small sets would have a single region.
class sample_regions {
 public:
  static constexpr Eigen::Index fewest_samples = 8;

  /// O(n log n).
  explicit sample_regions(const std::vector<location>& locations);

  [[nodiscard]] Eigen::Index count() const noexcept { return strips_ * parts_; }

  /// Returns the positions of all samples, region by region.
  [[nodiscard]] std::span<const Eigen::Index> all() const noexcept { return order_; }
  /// Returns the positions of one region's samples. The first regions are nearest to the highlight.
  [[nodiscard]] std::span<const Eigen::Index> operator[](Eigen::Index region) const noexcept {
    return part_of<const Eigen::Index>(part_of<const Eigen::Index>(order_, region / parts_, strips_), region % parts_,
                                       parts_);
  }

 private:
  [[nodiscard]] static Eigen::Index at_most(Eigen::Index most, Eigen::Index samples) noexcept {
    return std::clamp<Eigen::Index>(samples / fewest_samples, 1, most);
  }

  template <class Position>
  [[nodiscard]] static std::span<Position> part_of(std::span<Position> whole, Eigen::Index part,
                                                   Eigen::Index parts) noexcept {
    const Eigen::Index begin = whole.size() * part / parts, end = whole.size() * (part + 1) / parts;
    return whole.subspan(begin, end - begin);
  }

  std::vector<Eigen::Index> order_;
  Eigen::Index strips_, parts_;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/sample_regions.ipp>
#endif
