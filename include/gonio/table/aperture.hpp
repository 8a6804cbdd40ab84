#pragma once
/// A reading is the mean of the reflectance over two cones of directions: those of the lamp and of the receiver, as
/// seen from the sample. If a mirror-like lobe is a tenth as wide as the receiver's cone, the reading is about a
/// hundredth of the lobe's peak.

#include <gonio/core/direction.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace gonio {

/// The half angles of the two cones, radians. Zero is a single direction.
struct aperture {
  double source = 0.0;
  double receiver = 0.0;

  [[nodiscard]] bool is_point() const noexcept { return source == 0.0 && receiver == 0.0; }
  friend bool operator==(const aperture&, const aperture&) = default;
};

/// The largest half angle, radians.
inline constexpr double largest_half_angle = radians(45.0);

/// Returns the half angle, in radians, of a cone with this solid angle, in steradians. Throws gonio::error unless the
/// half angle is from 0 to `largest_half_angle`.
[[nodiscard]] double half_angle_of(double solid_angle);

/// Returns `count` pairs of directions spread evenly over both cones (Vogel 1979, "A better way to construct the
/// sunflower head", doi:10.1016/0025-5564(79)90080-4), without those below the horizon. `count` must be a power of two:
/// ring i of one cone is paired with the bit-reversed ring of the other (Hammersley's points).
[[nodiscard]] std::vector<direction_pair> pairs_within(const direction_pair& axes, const aperture& cones, int count);

/// Returns a reading: the mean of `value(light, receiver)` over the pairs of `pairs_within`, or its value at the axes
/// if all pairs are below the horizon.
template <class Value>
[[nodiscard]] auto mean_within(const direction_pair& axes, const aperture& cones, int count, Value&& value) {
  const std::vector<direction_pair> pairs = pairs_within(axes, cones, count);
  if (pairs.empty()) return value(axes.wi, axes.wo);  // all below the horizon
  auto mean = value(pairs.front().wi, pairs.front().wo);
  for (std::size_t i = 1; i < pairs.size(); ++i) mean += value(pairs[i].wi, pairs[i].wo);
  mean /= static_cast<double>(pairs.size());
  return mean;
}

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/table/impl/aperture.ipp>
#endif
