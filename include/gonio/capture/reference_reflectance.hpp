#pragma once
/// How much light a white reference reflects: a number, or a table by the angles of light and viewer. No
/// reference is quite matte; its maker's table, or one's own, says by how much.
///
/// The factor is the reference's BRDF times pi (radiance beside that of a perfect diffuser under the same light). A
/// measured BRDF is in proportion to it (Nielsen's thesis 2016, note on relative BRDF measurement, Eq. 18).

#include <gonio/core/direction.hpp>
#include <gonio/core/rgb.hpp>

#include <Eigen/Core>

#include <vector>

namespace gonio::capture {

/// The reflectance factor of a white reference for each pair of directions and each channel.
///
/// `reference_reflectance(0.99)` is the same everywhere; `.reflectance = 0.99` of a calibration makes one, too.
class reference_reflectance {
 public:
  /// The same for all directions and channels. Throws gonio::error unless it is above 0 and up to 1.
  reference_reflectance(double everywhere = 0.99);  // NOLINT: a number is a reflectance

  /// A table over the polar angles of light and viewer, in radians; without angles of the viewer, the same for all.
  /// `factors` has the viewers of the first light first, then those of the next. Between angles it is linear in each.
  ///
  /// Throws gonio::error if there is no angle of the light, if angles do not ascend from 0 to a right angle at most, if
  /// there is not one factor for each pair of angles, or if a channel is not above 0 and up to `largest_possible`.
  reference_reflectance(std::vector<double> theta_i, std::vector<double> theta_o, std::vector<rgb> factors);

  /// The factor for a pair of directions; azimuths do not matter. Throws gonio::error naming the angle if the table
  /// does not cover it: nothing is extrapolated. O(log(number of angles)).
  [[nodiscard]] rgb at(const direction_pair& pair) const;

  /// Of all channels of the table, sr^-1 times pi.
  [[nodiscard]] double largest() const;

  /// The factor of a single pair of directions may be above that of a perfect diffuser, but not by as much as this:
  /// such a number is a percentage.
  static constexpr double largest_possible = 1.5;

 private:
  std::vector<double> theta_i_, theta_o_;  ///< empty: the factor does not depend on the angle
  std::vector<rgb> factors_;
};

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/reference_reflectance.ipp>
#endif
