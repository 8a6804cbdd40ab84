#pragma once
/// How readings of a camera become reflectances: what is known of the camera and of the white reference.

#include "command.hpp"
#include <gonio/capture/calibration.hpp>
#include <gonio/io/measurements/scan_journal.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace cli {

struct calibration_options {
  double gamma = 0.0;                          ///< of a camera that is known; 0: find its response
  std::filesystem::path reflectance = "0.99";  ///< of the white reference: a number, or a table's file
  double saturation = 0.98;
  gonio::capture::sensor_noise noise{.read = 1.6, .shot = 0.2};
};

/// Adds `--reflectance`, a number or a file.
void add_reflectance_option(command& to, std::filesystem::path& given);

/// What was given with it as a number, if it is one. Throws gonio::error unless that is from 0.01 to 1.
[[nodiscard]] std::optional<double> number_of_reflectance(const std::filesystem::path& given);

/// The number, or the table that the file has (docs/reference/formats.md).
[[nodiscard]] gonio::capture::reference_reflectance reflectance_of(const std::filesystem::path& given);

/// Adds `--reflectance`, `--gamma`, `--saturation`, `--read-noise`, `--shot-noise` and `--flicker`.
void add_calibration_options(command& to, calibration_options& options);

/// The readings of a scan that are there.
[[nodiscard]] std::vector<gonio::capture::reading> readings_of(const gonio::io::recorded_scan& scan);

/// The calibration of a camera, whose response is found from these readings unless it is known.
[[nodiscard]] gonio::capture::calibration calibration_of(const calibration_options& options,
                                                         std::span<const gonio::capture::reading> readings,
                                                         std::uint16_t largest_count);

/// What was measured of a reference, for poses at which it was not. Throws gonio::error if nothing was.
[[nodiscard]] gonio::capture::reference_readings reference_readings_of(const gonio::io::recorded_scan& scan);

}  // namespace cli
