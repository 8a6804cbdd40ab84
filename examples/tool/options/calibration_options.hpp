#pragma once
/// The options for the camera and the white reference, which convert readings to reflectance.

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
  double gamma = 0.0;                          ///< known gamma of the camera; 0: estimate its response
  std::filesystem::path reflectance = "0.99";  ///< of the white reference: a number, or a table's file
  double saturation = 0.98;
  gonio::capture::sensor_noise noise{.read = 1.6, .shot = 0.2};
};

/// Adds `--reflectance`, a number or a file.
void add_reflectance_option(command& to, std::filesystem::path& given);

/// Returns the given reflectance as a number, if it is one. Throws gonio::error unless the number is from 0.01 to 1.
[[nodiscard]] std::optional<double> number_of_reflectance(const std::filesystem::path& given);

/// Returns the given reflectance: the number, or the table in the file (docs/reference/formats.md).
[[nodiscard]] gonio::capture::reference_reflectance reflectance_of(const std::filesystem::path& given);

/// Adds `--reflectance`, `--gamma`, `--saturation`, `--read-noise`, `--shot-noise` and `--flicker`.
void add_calibration_options(command& to, calibration_options& options);

/// Returns the readings of a scan; leaves out poses without one.
[[nodiscard]] std::vector<gonio::capture::reading> readings_of(const gonio::io::recorded_scan& scan);

/// Returns the calibration; estimates the camera's response from the readings unless --gamma states it.
[[nodiscard]] gonio::capture::calibration calibration_of(const calibration_options& options,
                                                         std::span<const gonio::capture::reading> readings,
                                                         std::uint16_t largest_count);

/// Returns the readings of a white reference with their poses. Throws gonio::error if there is none.
[[nodiscard]] gonio::capture::reference_readings reference_readings_of(const gonio::io::recorded_scan& scan);

}  // namespace cli
