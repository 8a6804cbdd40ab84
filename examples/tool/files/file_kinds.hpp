#pragma once
/// All kinds of files that hold a material, and the conversions between them and to samples. A new format of complete
/// materials is a line in `file_kinds.cpp`; formats of samples are in `measurement_kinds.cpp`.

#include "measurement_files.hpp"
#include <gonio/core/parallel.hpp>
#include <gonio/io/materials/mbsdf.hpp>
#include <gonio/io/materials/rgl.hpp>
#include <gonio/model/tabulate_adaptively.hpp>
#include <gonio/table/brdf_table.hpp>
#include <gonio/table/sample_set.hpp>
#include <gonio/table/spectral_table.hpp>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace cli {

/// The content of a file: a table over half and difference angles, tables that follow the highlight, a table over polar
/// angles, or samples.
using file_content =
    std::variant<gonio::brdf_table, gonio::io::rgl_material, gonio::io::mbsdf_material, gonio::sample_set>;

/// Options of writing a file.
struct writing {
  bool as_spectra = false;  ///< .bsdf: reflectance at wavelengths instead of RGB
  Eigen::Index polar_steps =
      0;  ///< .mbsdf, .xompt: steps of each polar angle, twice as many of the azimuth; 0: default
  double albedo_tolerance = gonio::model::usual_albedo_tolerance;  ///< .bsdf
  bool as_halves = false;                                          ///< .npy: half floats instead of float32
  bool keeps_negative = false;  ///< .bsdf, .mbsdf, .xompt: write negative values unchanged, not as 0
  gonio::thread_count threads;
};

struct file_kind {
  std::string_view name;
  std::vector<std::string_view> extensions;  ///< in lower case
  std::string_view magic;                    ///< the first bytes of its files; empty if only the name identifies them
  /// nullptr: read by `read_measurements`.
  file_content (*parse)(std::span<const std::byte> bytes, const std::string& name) = nullptr;
  /// Throws gonio::error if the format cannot hold the content; nullptr if the kind is only read.
  void (*write)(const std::filesystem::path& path, const file_content& content, const writing& how) = nullptr;
};

[[nodiscard]] const std::vector<file_kind>& file_kinds();

/// Reads a file of any kind, identified by its first bytes or else by its extension; reads samples with the given
/// options. Throws gonio::error for other kinds, and if the kind's reader refuses the file.
[[nodiscard]] file_content read_file(const std::filesystem::path& path, const measurement_options& reading = {});

/// Returns the kind of a file to write, from its name. Throws gonio::error naming the possible kinds.
[[nodiscard]] const file_kind& written_kind(const std::filesystem::path& path);

/// Writes a file of the kind that its name implies.
void write_file(const std::filesystem::path& path, const file_content& content, const writing& how = {});

/// Writes a material in spectra (.bsdf) with as many of its wavelengths as necessary, and prints their number.
void write_spectra(const std::filesystem::path& path, const gonio::spectral_table& table,
                   const std::string& description, const writing& how);

}  // namespace cli
