#pragma once
/// Images of a flat sample by a camera that is close to it, under a distant light: every pixel has its own viewing
/// direction. Xu, Nielsen, Yu, Jensen and Ramamoorthi 2016 (doi:10.1145/2980179.2982396), section 5.2 and Fig. 4.

#include <gonio/design/capture_geometry.hpp>

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace gonio {
class pinhole_camera;  // core/pinhole_camera.hpp, which needs more of Eigen than all else here
}

namespace gonio::design {

/// The apparatus.
struct near_field_options {
  /// alpha = 2 atan(r / R) in radians, for a disc of radius r and a camera at distance R from its centre.
  double field_of_view = radians(25.0);
  /// Samples along the diameter of the disc as seen from above; the image's pixels, or blocks of them.
  Eigen::Index pixels = 24;
  /// Distance of neighbouring candidates in radians: of the polar angles, and of the azimuth between light and camera.
  double step = radians(5.0);
  /// Lights and cameras beyond this polar angle are no candidates.
  double largest_polar_angle = radians(85.0);
  /// The camera's, or the light's, polar angle if it cannot be chosen.
  std::optional<double> fixed_camera = {}, fixed_light = {};
  capture_constraint constraint = {};
};

/// The camera of such an image: at distance 1 in the direction wo, its square image just around the disc, whose
/// radius is tan(field_of_view / 2).
[[nodiscard]] pinhole_camera near_field_camera(const direction& wo, double field_of_view, Eigen::Index pixels);

/// A candidate is a polar angle of the light, one of the camera, and the azimuth from camera to light. An azimuth and
/// its negative give mirror images of one another: they are from 0 to pi.
class near_field_geometry {
 public:
  /// Throws gonio::error unless the field of view is from 0 to 90 degrees, the step and the largest angle positive, and
  /// there is at least one candidate.
  explicit near_field_geometry(const near_field_options& options = {});

  [[nodiscard]] const near_field_options& options() const noexcept { return options_; }
  [[nodiscard]] Eigen::Index size() const noexcept { return Eigen::Index{extents_[0]} * extents_[1] * extents_[2]; }

  /// Azimuths are all the same where light or camera is at the zenith: the first stands for them.
  [[nodiscard]] bool allows(Eigen::Index candidate) const;

  /// Light and camera as seen from the centre of the sample; the camera in the half plane of positive x.
  [[nodiscard]] direction_pair centre(Eigen::Index candidate) const;

  /// The candidate whose light and camera are next to those of a pair.
  [[nodiscard]] Eigen::Index nearest(const direction_pair& pair) const;

  /// One direction for each pixel whose ray meets the disc, and which the light and the camera are above.
  [[nodiscard]] std::vector<half_difference> directions(Eigen::Index candidate) const;

  [[nodiscard]] std::optional<Eigen::Index> stepped(Eigen::Index from, const grid_step& step) const;

 private:
  [[nodiscard]] double polar(const std::optional<double>& fixed, int steps) const noexcept {
    return fixed ? *fixed : options_.step * steps;
  }

  [[nodiscard]] grid_step place(Eigen::Index candidate) const noexcept {
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
