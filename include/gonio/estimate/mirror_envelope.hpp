#pragma once
/// No dips of an estimate in the mirror direction, where no measured material has one: of twenty, with each theta_d up
/// to 65 degrees, none has less luminance at theta_h = 0 than .956 of its largest below 8 degrees. Half of the
/// estimates from 20 samples had less than .9, down to .44: how much brighter than its surroundings that direction is,
/// in logarithms, goes from 0 to 8 in materials, and a Gaussian takes it for symmetric. docs/decisions/0038.

#include <gonio/core/parallel.hpp>
#include <gonio/table/brdf_table.hpp>
#include <gonio/table/channels.hpp>
#include <gonio/table/location.hpp>
#include <gonio/table/spectral_table.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace gonio {

/// Values at one theta_d and phi_d, given from theta_h = 8 degrees towards 0: where one is darker than the brightest
/// before it, a share of the brightest makes up for the rest.
template <class Value>
class mirror_envelope {
 public:
  /// Reaches so far from the mirror direction, in radians.
  static constexpr double theta_h = radians(8.0);

  /// All of a dip is filled up to a theta_d of 70 degrees and nothing from 80 degrees on: there lobes of rough
  /// materials are brighter elsewhere than in the mirror direction.
  explicit mirror_envelope(double theta_d) : share_(share_at(theta_d)) {}

  [[nodiscard]] static double share_at(double theta_d) noexcept {
    return std::clamp((radians(80.0) - theta_d) / radians(10.0), 0.0, 1.0);
  }
  [[nodiscard]] static bool reaches(const half_difference& angles) noexcept {
    return angles.theta_h < theta_h && share_at(angles.theta_d) > 0.0;
  }

  /// The next value, filled.
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

/// By what channels are compared: the luminance of their colour, or the mean of wavelengths that have none.
[[nodiscard]] double brightness(const channels& kinds, const Eigen::ArrayXd& values);

/// Fills the dips of a table. O(values of its highlight).
void fill_mirror_dips(brdf_table& table, thread_count threads = {});
/// The same of wavelengths, seen as `kinds` says.
void fill_mirror_dips(spectral_table& table, const channels& kinds, thread_count threads = {});

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/mirror_envelope.ipp>
#endif
