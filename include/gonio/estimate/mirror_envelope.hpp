#pragma once
/// Removes dips of an estimate in the mirror direction (theta_h = 0). No measured material has such a dip: for each of
/// twenty materials and each theta_d up to 65 degrees, the luminance at theta_h = 0 is at least .956 of the largest
/// luminance at theta_h below 8 degrees. In half of the estimates from 20 random samples, this ratio was less than .9,
/// down to .44. The components cause the dips. In materials, the logarithm of the luminance at theta_h = 0 relative to
/// its surroundings is from 0 to 8, never negative. A Gaussian prior is symmetric and also allows negative values.
/// docs/decisions/0038-no-dips-in-the-mirror-direction.md.

#include <gonio/core/parallel.hpp>
#include <gonio/table/brdf_table.hpp>
#include <gonio/table/channels.hpp>
#include <gonio/table/location.hpp>
#include <gonio/table/spectral_table.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace gonio {

/// Takes values at one theta_d and phi_d, from theta_h = 8 degrees towards 0. If a value is darker than the brightest
/// value so far, raises it towards this brightest value.
template <class Value>
class mirror_envelope {
 public:
  /// The theta_h at which filling begins, in radians.
  static constexpr double theta_h = radians(8.0);

  /// Fills dips completely up to a theta_d of 70 degrees, and not at all from 80 degrees on, where lobes of rough
  /// materials are brightest outside of the mirror direction.
  explicit mirror_envelope(double theta_d) : share_(share_at(theta_d)) {}

  [[nodiscard]] static double share_at(double theta_d) noexcept {
    return std::clamp((radians(80.0) - theta_d) / radians(10.0), 0.0, 1.0);
  }
  [[nodiscard]] static bool reaches(const half_difference& angles) noexcept {
    return angles.theta_h < theta_h && share_at(angles.theta_d) > 0.0;
  }

  /// Returns the next value, raised if it is in a dip.
  [[nodiscard]] Value next(const Value& value, double brightness) {
    if (brightness < most_) return value + share_ * (1.0 - brightness / most_) * brightest_;
    most_ = brightness;
    brightest_ = value;
    return value;
  }

 private:
  double share_, most_ = 0.0;
  Value brightest_;
};

/// Returns the brightness by which values are compared: the luminance of the channels' colour, or the mean of the
/// values if no wavelength is visible.
[[nodiscard]] double brightness(const channels& kinds, const Eigen::ArrayXd& values);

/// Fills the dips of a table. O(values of its highlight).
void fill_mirror_dips(brdf_table& table, thread_count threads = {});
/// Fills the dips of a table of wavelengths, whose brightness `kinds` defines.
void fill_mirror_dips(spectral_table& table, const channels& kinds, thread_count threads = {});

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/mirror_envelope.ipp>
#endif
