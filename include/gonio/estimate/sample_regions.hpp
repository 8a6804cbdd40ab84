#pragma once
/// Samples grouped by the angles of their half and difference vectors: whatever goes wrong in a measurement does so in
/// all directions alike, but a fit may be good for the diffuse part of a surface and bad in its highlight.

#include <gonio/table/location.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

namespace gonio {

/// At most six strips of theta_h with equal numbers of samples, each cut into at most four parts of theta_d: as many as
/// leave eight samples in each. With fewer in a region chance decides; with more, few samples have but one.
class sample_regions {
 public:
  static constexpr Eigen::Index fewest_samples = 8;

  /// O(n log n).
  explicit sample_regions(const std::vector<location>& locations);

  [[nodiscard]] Eigen::Index count() const noexcept { return strips_ * parts_; }

  /// The positions of all samples.
  [[nodiscard]] std::span<const Eigen::Index> all() const noexcept { return order_; }
  /// Those of one region; the first regions are nearest to the highlight.
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
