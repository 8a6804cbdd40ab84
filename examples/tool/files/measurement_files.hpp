#pragma once
/// Files of measurements, recognised by name or first bytes, and the options for reading them.

#include "json.hpp"
#include "tool/options/command.hpp"
#include <gonio/core/spectrum.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/table/brdf_table.hpp>
#include <gonio/table/sample_set.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace cli {

/// Half angles in degrees.
struct aperture_option {
  double source = 0.0, receiver = 0.0;

  [[nodiscard]] gonio::aperture in_radians() const { return {gonio::radians(source), gonio::radians(receiver)}; }
};

/// The user's statements about a file, and the choice of its samples.
struct measurement_options {
  std::string quantity;              ///< a name of `gonio::io::sample_quantity`; empty if not stated
  std::vector<std::string> columns;  ///< lists like "theta_o=Winkel,g=Y"
  std::optional<gonio::io::theta_o_sign> sign = {};
  std::optional<gonio::illuminant> light = {};  ///< illuminant for wavelengths; none: D65
  std::optional<double> rotation = {};          ///< light's azimuth in degrees: read only this rotation
  std::string side = {}, band = {};             ///< for files with several blocks; empty if not chosen
  bool takes_anisotropic = false;               ///< accepts samples that differ between rotations
  aperture_option aperture = {};                ///< for all samples, if the file states no half angles

  [[nodiscard]] bool empty() const noexcept {
    return quantity.empty() && columns.empty() && !sign && side.empty() && band.empty();
  }
};

/// Adds `--quantity`, `--columns`, `--theta-o-sign`, `--rotation`, `--side` and `--band` to a subcommand that reads
/// measurements.
void add_measurement_options(command& to, measurement_options& options);

/// Adds `--source-half-angle` and `--receiver-half-angle`, in degrees.
void add_aperture_options(command& to, aperture_option& given);

/// Returns the options for the reader of .csv files, which prints what it ignores or assumes on standard error.
[[nodiscard]] gonio::io::sample_reading reading_of(const measurement_options& options = {});

/// Does the file hold measurements? Decides by its name or first bytes.
[[nodiscard]] bool holds_measurements(const std::filesystem::path& path);

/// Throws gonio::error if options for reading measurements were given, but the file holds no measurements.
void require_unused(const measurement_options& options, const std::filesystem::path& path);

/// Reads measurements in the file's channels from CSV or from another recognised format (measurement_kinds.hpp).
/// Refuses --columns for files other than CSV. Prints a warning on standard error for everything ignored, assumed or
/// implausible.
[[nodiscard]] gonio::io::sample_file read_measurement_file(const std::filesystem::path& path,
                                                           const measurement_options& options = {});

/// Reads colours: refuses wavelengths if none is visible.
[[nodiscard]] gonio::io::sample_file read_colour_file(const std::filesystem::path& path,
                                                      const measurement_options& options = {});
[[nodiscard]] gonio::sample_set as_colours(const std::filesystem::path& path, const gonio::sample_set& samples);

/// Returns the colours without the file's other statements.
[[nodiscard]] gonio::sample_set read_measurements(const std::filesystem::path& path,
                                                  const measurement_options& options = {});

/// Returns the file's statements about its measurements, for --json: quantity, wavelength_nm or wavelengths_nm,
/// instrument, date and conditions. Absent statements have no key.
[[nodiscard]] json facts_of(const gonio::io::sample_file& file);

/// Writes a table in the format that the name implies: see `written_kind`.
void write_table(const std::filesystem::path& path, const gonio::brdf_table& table);

}  // namespace cli
