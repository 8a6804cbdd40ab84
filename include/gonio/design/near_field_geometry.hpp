#pragma once
/// Images of a flat sample by a close camera under a distant light. Every pixel has its own viewing direction. Xu,
/// Nielsen, Yu, Jensen and Ramamoorthi 2016 (doi:10.1145/2980179.2982396), section 5.2 and Fig. 4.

#include <gonio/design/capture_geometry.hpp>

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace gonio {
class pinhole_camera;  // defined in core/pinhole_camera.hpp, which includes more of Eigen than this file needs
}

namespace gonio::design {

struct near_field_options {
  /// The field of view in radians: 2 atan(r / R) for a disc of radius r and a camera at distance R from its centre.
  double field_of_view = radians(25.0);
  /// Samples along the disc's diameter as seen from above: pixels, or blocks of pixels.
  Eigen::Index pixels = 24;
  /// Step between candidates in radians: of the polar angles, and of the azimuth between light and camera.
  double step = radians(5.0);
  /// Lights and cameras at larger polar angles are not candidates.
  double largest_polar_angle = radians(85.0);
  /// If set, the polar angle at which the camera or the light is fixed.
  std::optional<double> fixed_camera = {}, fixed_light = {};
  capture_constraint constraint = {};
};

/// Returns the camera of a near-field image: at distance 1 in the direction wo. Its square image just contains the
/// disc, whose radius is tan(field_of_view / 2).
[[nodiscard]] pinhole_camera near_field_camera(const direction& wo, double field_of_view, Eigen::Index pixels);

/// A candidate has a polar angle of the light, a polar angle of the camera, and the azimuth from camera to light. The
/// azimuth is from 0 to pi, because a negative azimuth gives the mirror image.
class near_field_geometry {
 public:
  /// Throws gonio::error unless the field of view and the largest polar angle are between 0 and 90 degrees, there are
  /// pixels, the step is positive, fixed directions are above the horizon, and at least one candidate is allowed.
  explicit near_field_geometry(const near_field_options& options = {});

  [[nodiscard]] const near_field_options& options() const noexcept { return options_; }
  [[nodiscard]] Eigen::Index size() const noexcept { return Eigen::Index{extents_[0]} * extents_[1] * extents_[2]; }

  /// If light or camera is at the normal, all azimuths give the same image, and only the first is allowed.
  [[nodiscard]] bool allows(Eigen::Index candidate) const;

  /// Returns light and camera as seen from the centre of the sample. The camera is in the half plane of positive x.
  [[nodiscard]] direction_pair centre(Eigen::Index candidate) const;

  /// Returns the candidate whose light and camera are nearest to the directions of a pair.
  [[nodiscard]] Eigen::Index nearest(const direction_pair& pair) const;

  /// Returns one direction for each pixel whose ray meets the disc. If no ray meets it, returns the direction of the
  /// centre.
  [[nodiscard]] std::vector<half_difference> directions(Eigen::Index candidate) const;

  [[nodiscard]] std::optional<Eigen::Index> stepped(Eigen::Index from, const grid_step& step) const;

 private:
  [[nodiscard]] double polar(const std::optional<double>& fixed, int steps) const noexcept {
    return fixed ? *fixed : options_.step * steps;
  }

  [[nodiscard]] grid_step position_of(Eigen::Index candidate) const noexcept {
    const auto n = static_cast<int>(candidate);
    return {n / (extents_[1] * extents_[2]), n / extents_[2] % extents_[1], n % extents_[2]};
  }

  [[nodiscard]] Eigen::Index number(const grid_step& at) const noexcept {
    return (at[0] * extents_[1] + at[1]) * extents_[2] + at[2];
  }

  near_field_options options_;
  grid_step extents_{};
};
static_assert(capture_geometry<near_field_geometry>);

}  // namespace gonio::design

#if !defined(GONIO_COMPILED)
#include <gonio/design/impl/near_field_geometry.ipp>
#endif
