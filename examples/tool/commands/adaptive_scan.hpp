#pragma once
/// Chooses the next pose of a scan from its readings so far.

#include "tool/options/calibration_options.hpp"
#include <gonio/basis/pca.hpp>
#include <gonio/evaluate/next_measurement.hpp>
#include <gonio/io/measurements/scan_journal.hpp>

#include <Eigen/Core>

#include <filesystem>
#include <functional>
#include <optional>

namespace cli {

struct adaptive_options {
  std::filesystem::path prior, reference;
  double until = 0.1;      ///< stop when half of all directions are known to this relative deviation
  Eigen::Index most = 40;  ///< largest number of poses
};

/// Chooses the next pose of a scan. Before each choice, prints how well the material is known.
class adaptive_choice {
 public:
  /// Reads the prior and the scan of the reference. Throws gonio::error if either cannot be used, or if the reference
  /// was measured by another camera.
  adaptive_choice(const adaptive_options& options, const calibration_options& calibration, std::uint16_t largest_count);

  /// Returns the next pose of a scan; nothing if the material is known well enough or the limit of poses is
  /// reached. Throws gonio::error if no reading can be used, or if no reachable direction is left.
  [[nodiscard]] std::optional<gonio::direction_pair> next(
      const gonio::io::recorded_scan& scan,
      const std::function<bool(const gonio::direction_pair&)>& is_reachable) const;

 private:
  adaptive_choice(const adaptive_options& options, const calibration_options& calibration,
                  const gonio::io::recorded_scan& reference);

  [[nodiscard]] gonio::sample_set samples_of(const gonio::io::recorded_scan& scan) const;

  adaptive_options options_;
  gonio::capture::calibration calibration_;
  gonio::capture::reference_readings reference_;
  gonio::measurement_chooser<gonio::log_relative> chooser_;
};

}  // namespace cli
