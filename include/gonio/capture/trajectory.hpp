#pragma once
/// Plans the path of a camera on a robot around a sample that an arc of lamps lights (Nielsen's thesis 2016, note on
/// the gonioreflectometer: Eq. 1-5 and Table 1).

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

/// A camera that a robot holds on a sphere, looking at its centre. Angles are in the robot's axes.
struct camera_pose {
  Eigen::Vector3d position;  ///< in mm
  double pitch = 0.0;        ///< beta of Eq. 4, about the y axis
  double yaw = 0.0;          ///< gamma of Eq. 5, about the z axis

  /// Returns the rotation from the tool's axes to the robot's axes: first by the pitch, then by the yaw. The camera
  /// looks along the tool's x axis. Callers must include <Eigen/Geometry>.
  [[nodiscard]] Eigen::Quaternion<double> orientation() const;
  [[nodiscard]] direction looks_along() const;
};

/// The sphere on which the camera moves, and its orientation in the robot's axes.
struct camera_sphere {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< centre of the sphere, where the sample is, in mm
  double radius = 350.0;                             ///< in mm
  /// The azimuth of the arc's plane in the robot's axes. The note's arc lies along the robot's y axis.
  double arc_azimuth = std::numbers::pi / 2.0;

  /// Throws gonio::error unless the radius is positive and all numbers are finite.
  void require_usable() const;

  /// Returns the pose that sees the sample from a direction in the sample's axes (Eq. 1-5): z is the normal, and the
  /// arc of lamps lies above x.
  [[nodiscard]] camera_pose towards(const direction& wo) const;

  /// Returns the direction in the sample's axes from which a pose sees the sample: the inverse of `towards`.
  [[nodiscard]] direction seen_from(const camera_pose& pose) const;
};

/// The position and orientation of a tool, for a robot's controller.
struct tool_pose {
  Eigen::Vector3d position;  ///< in mm, in the robot's axes
  /// w, x, y, z of a unit quaternion q (Hamilton's product): a vector v in the tool's axes is q v q* in the robot's
  /// axes. The tool looks along its x axis.
  Eigen::Vector4d quaternion;

  [[nodiscard]] direction looks_along() const;
};

/// Returns the poses from which a tool on a sphere looks at its centre, one for each direction in the sample's axes, in
/// the same order (Eq. 1-5). q and -q are the same orientation. The first q has w >= 0. The sign of each further q is
/// the one nearer to the q before, so that an interpolating controller turns the short way. O(directions).
///
/// Throws gonio::error as `require_usable` does.
[[nodiscard]] std::vector<tool_pose> tool_path(const camera_sphere& sphere, std::span<const direction> directions);

/// A grid of directions with steps in radians that divide a right angle: 7.5 degrees in the note.
struct angular_grid {
  double step = radians(7.5);

  /// Returns the number of steps from the normal to the horizon. Throws gonio::error unless the step divides 90
  /// degrees.
  [[nodiscard]] int steps_to_horizon() const;
};

/// Returns directions towards an arc's lamps in the sample's axes, from one end of the arc to the other. Omits the two
/// lamps at the horizon, which do not light the sample.
[[nodiscard]] std::vector<direction> arc_lamps(const angular_grid& grid = {});

/// Returns the directions from which the camera sees the sample: rows of equal elevation, upwards from one step above
/// the horizon, each from azimuth 0 to 180 degrees, and last the zenith. The directions on the other side of the arc's
/// plane are omitted, because they are symmetric.
[[nodiscard]] std::vector<direction> half_hemisphere(const angular_grid& grid = {});

/// Returns a pair of directions as the arc measures it. Rotates both about the normal until the light is above the
/// arc's x axis. Mirrors the viewer at the arc's plane if needed, to an azimuth from 0 to 180 degrees. An isotropic
/// material has the same BRDF at the resulting pair. If the light is at the zenith, the viewer ends above the x axis.
[[nodiscard]] direction_pair above_arc(const direction_pair& pair);

/// Returns a short path through some points. Starts at the first point, goes to the nearest remaining point each time,
/// and does not return. Then reverses sections of the path while that shortens it (2-opt; G. Croes, Operations Research
/// 6, 1958, doi:10.1287/opre.6.6.791). `between(i, j)` is the symmetric distance between two points. O(count^2) for
/// each round over all sections. The result is deterministic.
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

/// Returns a short path through directions. The camera moves along its sphere, so it never comes close to the sample.
[[nodiscard]] std::vector<Eigen::Index> short_way(const std::vector<direction>& directions);

/// Returns the length in radians of the path through directions in the given order.
[[nodiscard]] double length_of_way(const std::vector<direction>& directions, const std::vector<Eigen::Index>& order);

/// The durations of the parts of a scan.
struct scan_pace {
  double radians_per_second = radians(5.0);
  double settling = 2.0;                                ///< seconds at each pose before the first image
  double exposure = 0.0125 + 0.025 + 0.05 + 0.1 + 0.2;  ///< seconds of all exposures under one lamp together
  double switching = 1.0;  ///< seconds per lamp to switch it on and off and read out images
};

/// Returns the duration in seconds of a scan along a path in radians. At each stop it takes images under each lamp in
/// turn. Throws gonio::error for a speed that is not positive.
[[nodiscard]] double duration_of_scan(double length_of_way, Eigen::Index stops, Eigen::Index lamps,
                                      const scan_pace& pace = {});

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/trajectory.ipp>
#endif
