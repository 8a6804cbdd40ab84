#pragma once
/// Every kind of file that holds a material, and what turns one kind into another or into samples. A new format of
/// whole materials is a line in `file_kinds.cpp`; formats of samples stand in `measurement_kinds.cpp`.

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

/// What is in a file: a table over half and difference angles, tables that follow the highlight, a table over polar
/// angles, or samples.
using file_content =
    std::variant<gonio::brdf_table, gonio::io::rgl_material, gonio::io::mbsdf_material, gonio::sample_set>;

/// How a file is written.
struct writing {
  bool as_spectra = false;  ///< .bsdf: reflectance at wavelengths, instead of in RGB
  Eigen::Index polar_steps =
      0;  ///< .mbsdf, .xompt: steps of each polar angle, twice as many of the azimuth; 0: the usual
  double albedo_tolerance = gonio::model::usual_albedo_tolerance;  ///< .bsdf
  bool as_halves = false;                                          ///< .npy: half floats instead of float32
  bool keeps_negative = false;  ///< .bsdf, .mbsdf, .xompt: negative values are written as they are, not as 0
  gonio::thread_count threads;
};

struct file_kind {
  std::string_view name;
  std::vector<std::string_view> extensions;  ///< in small letters
  std::string_view magic;                    ///< what its files begin with; nothing if the name alone tells
  /// nullptr: as `read_measurements` reads it.
  file_content (*parse)(std::span<const std::byte> bytes, const std::string& name) = nullptr;
  /// Throws gonio::error if the format cannot hold the content; nullptr if it is only read.
  void (*write)(const std::filesystem::path& path, const file_content& content, const writing& how) = nullptr;
};

[[nodiscard]] const std::vector<file_kind>& file_kinds();

/// Reads a file of any kind, told by what it begins with or else by how its name ends; samples as the options say.
/// Throws gonio::error for other kinds, and for what the kind's reader refuses.
[[nodiscard]] file_content read_file(const std::filesystem::path& path, const measurement_options& reading = {});

/// The kind that a file to be written has by its name. Throws gonio::error naming those that there are.
[[nodiscard]] const file_kind& written_kind(const std::filesystem::path& path);

/// Writes a file of the kind that its name asks for.
void write_file(const std::filesystem::path& path, const file_content& content, const writing& how = {});

/// Writes a material in spectra (.bsdf) by those of its wavelengths that suffice, and says how many these are.
void write_spectra(const std::filesystem::path& path, const gonio::spectral_table& table,
                   const std::string& description, const writing& how);

}  // namespace cli
