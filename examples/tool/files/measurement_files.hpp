#pragma once
/// Files whose format is told from their name or their beginning, and the options of how measurements are read.

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

/// What a user says of a file that does not say it itself.
struct measurement_options {
  std::string quantity;              ///< a name of `gonio::io::sample_quantity`; empty if it is not stated
  std::vector<std::string> columns;  ///< lists like "theta_o=Winkel,g=Y"
  std::optional<gonio::io::theta_o_sign> sign = {};
  std::optional<gonio::illuminant> light = {};  ///< under which wavelengths are seen; none: D65
  std::optional<double> rotation = {};          ///< degrees: of the sample, whose other rotations are left out
  std::string side = {}, band = {};             ///< of files with several blocks; empty if not chosen
  bool takes_anisotropic = false;               ///< whether or not rotations differ
  aperture_option aperture = {};                ///< of all samples of a file that has none

  [[nodiscard]] bool empty() const noexcept {
    return quantity.empty() && columns.empty() && !sign && side.empty() && band.empty();
  }
};

/// Adds `--quantity`, `--columns`, `--theta-o-sign`, `--rotation`, `--side` and `--band`, for every subcommand that
/// reads measurements.
void add_measurement_options(command& to, measurement_options& options);

/// Adds `--source-half-angle` and `--receiver-half-angle`, in degrees.
void add_aperture_options(command& to, aperture_option& given);

/// How a file is read by these options, what is ignored or assumed being told as warnings on standard error.
[[nodiscard]] gonio::io::sample_reading reading_of(const measurement_options& options = {});

/// Do name or beginning say that the file holds measurements?
[[nodiscard]] bool holds_measurements(const std::filesystem::path& path);

/// Refuses options of how measurements are read, for a file that holds none.
void require_unused(const measurement_options& options, const std::filesystem::path& path);

/// Measurements in the channels that the file has: samples as CSV, or in a format of the field that is recognised
/// (measurement_kinds.hpp), which has no columns to name. What is ignored, assumed or implausible is told as a warning
/// on standard error.
[[nodiscard]] gonio::io::sample_file read_measurement_file(const std::filesystem::path& path,
                                                           const measurement_options& options = {});

/// The same for whoever needs colours: refuses wavelengths of which none is visible.
[[nodiscard]] gonio::io::sample_file read_colour_file(const std::filesystem::path& path,
                                                      const measurement_options& options = {});
[[nodiscard]] gonio::sample_set as_colours(const std::filesystem::path& path, const gonio::sample_set& samples);

/// The colours without what the file says of them.
[[nodiscard]] gonio::sample_set read_measurements(const std::filesystem::path& path,
                                                  const measurement_options& options = {});

/// What a file says of its measurements, for --json: quantity, wavelength_nm, instrument, date and conditions, those
/// that it states.
[[nodiscard]] json facts_of(const gonio::io::sample_file& file);

/// Writes a table in the format that the name asks for: see `written_kind`.
void write_table(const std::filesystem::path& path, const gonio::brdf_table& table);

}  // namespace cli
