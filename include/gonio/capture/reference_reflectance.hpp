#pragma once
/// The reflectance of a white reference: a number, or a table over the angles of light and viewer. No reference is
/// perfectly matte: take the table from the maker, or measure it.
///
/// The factor is the reference's BRDF times pi: its radiance relative to a perfect diffuser's under the same light. A
/// BRDF that is measured with the reference is proportional to this factor (Nielsen's thesis 2016, note on relative
/// BRDF measurement, Eq. 18).

#include <gonio/core/direction.hpp>
#include <gonio/core/rgb.hpp>

#include <Eigen/Core>

#include <vector>

namespace gonio::capture {

/// The reflectance factor of a white reference for each pair of directions and each channel.
///
/// `reference_reflectance(0.99)` has the same factor for all directions. Numbers convert implicitly: `.reflectance =
/// 0.99`.
class reference_reflectance {
 public:
  /// Takes one factor for all directions and channels. Throws gonio::error unless the factor is above 0 and at most 1.
  reference_reflectance(double everywhere = 0.99);  // NOLINT: a number is a reflectance

  /// A table over the polar angles of light and viewer, in radians. Without viewer angles, the factor is the same for
  /// all viewers. `factors` lists the factors at the first light angle for all viewer angles, then those at the second,
  /// and so on. Interpolation is bilinear.
  ///
  /// Throws gonio::error if there is no light angle, if angles do not ascend from 0 to at most a right angle, if there
  /// is not one factor for each pair of angles, or if a channel is not above 0 and at most `largest_possible`.
  reference_reflectance(std::vector<double> theta_i, std::vector<double> theta_o, std::vector<rgb> factors);

  /// Returns the factor for a pair of directions. Azimuths are ignored. Throws gonio::error that names the angle if the
  /// table does not cover it: nothing is extrapolated. O(log(number of angles)).
  [[nodiscard]] rgb at(const direction_pair& pair) const;

  /// Returns the largest factor over all angles and channels.
  [[nodiscard]] double largest() const;

  /// The upper limit of a factor. A factor may exceed 1, but a larger number is probably a percentage.
  static constexpr double largest_possible = 1.5;

 private:
  std::vector<double> theta_i_, theta_o_;  ///< empty: the factor does not depend on the angle
  std::vector<rgb> factors_;
};

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/reference_reflectance.ipp>
#endif
