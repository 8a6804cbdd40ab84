#pragma once
/// Where a robot takes a camera around a sample that an arc of lamps lights (Nielsen's thesis 2016, note on the
/// gonioreflectometer: Eq. 1-5 and Table 1).

#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace gonio::capture {

/// A camera that looks at the middle of a sphere from a place on it, as a robot takes it: angles in the robot's axes.
struct camera_pose {
  Eigen::Vector3d position;  ///< in mm
  double pitch = 0.0;        ///< beta of Eq. 4, about the y axis
  double yaw = 0.0;          ///< gamma of Eq. 5, about the z axis

  /// Turns the tool's axes to the robot's: first by the pitch, then by the yaw. The camera looks along the tool's x.
  /// Whoever asks includes <Eigen/Geometry>.
  [[nodiscard]] Eigen::Quaternion<double> orientation() const;
  [[nodiscard]] direction looks_along() const;
};

/// The sphere on which the camera moves, and how its axes lie in the robot's.
struct camera_sphere {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of the sample, in mm
  double radius = 350.0;                             ///< in mm
  /// The azimuth of the arc's plane in the robot's axes: the note's arc lies along the robot's y axis.
  double arc_azimuth = std::numbers::pi / 2.0;

  /// Throws gonio::error unless the radius is positive and all is finite.
  void require_usable() const;

  /// The pose from which a sample is seen along a direction in the sample's axes: z is its normal, the arc lies above x
  /// (Eq. 1-5).
  [[nodiscard]] camera_pose towards(const direction& wo) const;

  /// The direction in the sample's axes from which a pose sees it: the inverse of `towards`.
  [[nodiscard]] direction seen_from(const camera_pose& pose) const;
};

/// Where a tool is, and how it is turned, as a robot's controller takes it.
struct tool_pose {
  Eigen::Vector3d position;  ///< in mm, in the robot's axes
  /// w, x, y, z of a unit quaternion q (Hamilton's product): a vector v in the tool's axes is q v q* in the robot's.
  /// The tool looks along its x axis.
  Eigen::Vector4d quaternion;

  [[nodiscard]] direction looks_along() const;
};

/// The poses from which a tool on a sphere looks at its centre, one for each direction in the sample's axes, in their
/// order (Eq. 1-5). q and -q are the same orientation: the first q has w >= 0, each next one is the nearer of the two
/// to the one before, so that a controller that interpolates between them turns the short way. O(directions).
///
/// Throws gonio::error as `require_usable` does.
[[nodiscard]] std::vector<tool_pose> tool_path(const camera_sphere& sphere, std::span<const direction> directions);

/// Every n-th of a right angle, in radians: 7.5 degrees in the note.
struct angular_grid {
  double step = radians(7.5);

  /// Throws gonio::error unless the step divides 90 degrees.
  [[nodiscard]] int steps_to_horizon() const;
};

/// Directions towards an arc's lamps in the sample's axes, from one end of the arc to the other, without the two at the
/// horizon, which light nothing.
[[nodiscard]] std::vector<direction> arc_lamps(const angular_grid& grid = {});

/// Directions from which the camera sees the sample: rows of equal elevation from one step above the horizon up, each
/// from azimuth 0 to 180 degrees, and last the one from right above. What lies on the other side of the arc's plane is
/// the same by symmetry.
[[nodiscard]] std::vector<direction> half_hemisphere(const angular_grid& grid = {});

/// A pair of directions as the arc measures it: both turned about the normal until the light lies above the arc's
/// x axis, and the viewer, if need be, mirrored at the arc's plane to azimuths from 0 to 180 degrees. An isotropic
/// material has the same BRDF there. A light right above leaves the viewer above the x axis.
[[nodiscard]] direction_pair above_arc(const direction_pair& pair);

/// A short way through some places: from the first always to the nearest that is left, then, until none shortens the
/// way, stretches of it turned round (2-opt; G. Croes, Operations Research 6, 1958, doi:10.1287/opre.6.6.791).
/// `between(i, j)` is the way between two places, the same both ways. The way starts at the first place and does not
/// return. O(count^2) for each improvement's sweep; the result depends on nothing but the input.
template <class Between>
[[nodiscard]] std::vector<Eigen::Index> short_way(Eigen::Index count, const Between& between) {
  std::vector<Eigen::Index> order(count);
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  const auto step = [&](Eigen::Index i, Eigen::Index j) { return between(order[i], order[j]); };
  for (Eigen::Index i = 1; i < count; ++i) {
    Eigen::Index nearest = i;
    for (Eigen::Index j = i + 1; j < count; ++j)
      if (step(i - 1, j) < step(i - 1, nearest)) nearest = j;
    std::swap(order[i], order[nearest]);
  }
  constexpr double gain_worth_turning = 1e-9;
  for (bool improved = true; improved;) {
    improved = false;
    for (Eigen::Index i = 1; i + 1 < count; ++i)
      for (Eigen::Index j = i + 1; j < count; ++j) {
        const double after = j + 1 < count ? step(j, j + 1) - step(i, j + 1) : 0.0;
        if (step(i - 1, i) - step(i - 1, j) + after <= gain_worth_turning) continue;
        std::reverse(order.begin() + i, order.begin() + j + 1);
        improved = true;
      }
  }
  return order;
}

/// The way through directions: the camera moves along its sphere, so that it never comes close to the sample.
[[nodiscard]] std::vector<Eigen::Index> short_way(const std::vector<direction>& directions);

/// The length in radians of the way through directions in an order.
[[nodiscard]] double length_of_way(const std::vector<direction>& directions, const std::vector<Eigen::Index>& order);

/// What a scan spends its time on.
struct scan_pace {
  double radians_per_second = radians(5.0);
  double settling = 2.0;                                ///< seconds at each pose before the first image
  double exposure = 0.0125 + 0.025 + 0.05 + 0.1 + 0.2;  ///< seconds of all images under one lamp
  double switching = 1.0;                               ///< seconds for each lamp: on, off, and reading the images out
};

/// Seconds that a scan takes along a way, in radians, with some stops, at each of which images are taken under some
/// lamps, one after the other. Throws gonio::error for a speed that is not positive.
[[nodiscard]] double duration_of_scan(double length_of_way, Eigen::Index stops, Eigen::Index lamps,
                                      const scan_pace& pace = {});

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/trajectory.ipp>
#endif
