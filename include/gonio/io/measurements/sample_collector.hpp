#pragma once
/// Samples out of the tables of other programs: what the numbers of a direction are, and which directions count.

#include <gonio/core/direction.hpp>
#include <gonio/io/text/json_reader.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/table/aperture.hpp>
#include <gonio/table/channels.hpp>
#include <gonio/table/sample_set.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::io::detail {

/// Refuses a reflectance that no float holds.
void require_float_range(double reflectance, const text_place& place);

/// The number, which is refused by its name unless it is from `lowest` to `highest`.
[[nodiscard]] double require_between(double number, std::string_view name, double lowest, double highest,
                                     const text_place& place);

/// Is the direction above the horizon by more than the rounding of angles? Tables go to 90 degrees, where nothing can
/// be measured, and those about the specular direction go on below.
[[nodiscard]] inline bool is_above_horizon(const direction& w) noexcept { return w.z() > 1e-6; }

/// The half angle of a receiver by its solid angle, in steradians, which was read last. Refuses one beyond the largest
/// half angle.
[[nodiscard]] double receiver_half_angle(double solid_angle, const json_reader& read);

/// Which of azimuths, in degrees, are not the same as one before, or a turn apart. O(n log n).
[[nodiscard]] std::vector<bool> are_new_azimuths(std::span<const double> azimuths);

/// Collects samples, but those at or below the horizon.
class sample_collector {
 public:
  explicit sample_collector(channels kinds = channels::one_value()) : kinds_(std::move(kinds)), samples_(kinds_) {}
  /// Of CIE XYZ under D65, Y of a perfect diffuser being 1 / pi.
  [[nodiscard]] static sample_collector of_xyz();

  /// The number of values of a sample.
  [[nodiscard]] std::size_t channel_count() const noexcept { return static_cast<std::size_t>(kinds_.size()); }

  /// The samples that follow are of these wavelengths, in nanometres. Where they are others than those before, all
  /// become colours. Throws gonio::error unless they ascend.
  void use_wavelengths(std::span<const double> wavelengths);

  /// The cones of all samples.
  void use_aperture(const aperture& cones) noexcept { aperture_ = cones; }

  /// Of as many values as there are channels.
  void add(const direction_pair& pair, std::span<const double> values, double weight = 1.0);

  /// Throws gonio::error naming the file if there is no sample, or if wavelengths differ and some make no colour.
  [[nodiscard]] sample_set samples(const std::string& name) &&;

 private:
  channels kinds_;  ///< of what is added
  aperture aperture_;
  bool are_xyz_ = false, are_mixed_ = false, have_colours_ = true;
  sample_set samples_;
};

}  // namespace gonio::io::detail

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/sample_collector.ipp>
#endif
