#pragma once
/// The kinds of files that hold a material, and the conversions between them. `file_kinds.cpp` lists the formats of
/// complete materials, `measurement_kinds.cpp` those of samples.

#include "measurement_files.hpp"
#include <gonio/core/parallel.hpp>
#include <gonio/io/materials/mbsdf.hpp>
#include <gonio/io/materials/rgl.hpp>
#include <gonio/model/angle_grid_brdf.hpp>
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

/// The content of a file: a table over half and difference angles (MERL), adaptive tables (RGL), a table over polar
/// angles (MDL), a grid of four angles (UTIA, Zemax), or samples.
using file_content = std::variant<gonio::brdf_table, gonio::io::rgl_material, gonio::io::mbsdf_material,
                                  gonio::model::angle_grid_brdf, gonio::sample_set>;

/// Options for writing a file.
struct writing {
  bool as_spectra = false;  ///< .bsdf: reflectance at wavelengths instead of RGB
  bool as_zemax = false;    ///< .bsdf: Zemax's tabular format instead of the RGL database's
  Eigen::Index polar_steps =
      0;  ///< .mbsdf, .xompt: steps of each polar angle (the azimuth has twice as many); 0: default
  double albedo_tolerance = gonio::model::usual_albedo_tolerance;  ///< .bsdf
  bool as_halves = false;                                          ///< .npy: half floats instead of float32
  bool keeps_negative = false;  ///< .bsdf, .mbsdf, .xompt: write negative values unchanged, not as 0
  gonio::thread_count threads;
};

struct file_kind {
  std::string_view name;
  std::vector<std::string_view> extensions;  ///< in lower case
  std::string_view magic;                    ///< the first bytes of its files; empty if only the name identifies them
  /// Null if `read_measurements` reads the files of this kind.
  file_content (*parse)(std::span<const std::byte> bytes, const std::string& name) = nullptr;
  /// Throws gonio::error if the format cannot hold the content. Null if files of this kind are only read.
  void (*write)(const std::filesystem::path& path, const file_content& content, const writing& how) = nullptr;
};

[[nodiscard]] const std::vector<file_kind>& file_kinds();

/// Reads a file of any kind, identified by its first bytes or else by its extension; reads samples with the given
/// options. Throws gonio::error for other kinds, and if the kind's reader refuses the file.
[[nodiscard]] file_content read_file(const std::filesystem::path& path, const measurement_options& reading = {});

/// Reads a file of any kind to write it as another: like `read_file`, but a table of Zemax is a complete material
/// unless `output` is a file of samples.
[[nodiscard]] file_content read_file_for(const std::filesystem::path& output, const std::filesystem::path& path,
                                         const measurement_options& reading);

/// Reads a complete material as a table. A material in a renderer's format is evaluated at the cells of MERL's grid; a
/// file with an unknown extension is read as a MERL table. Throws gonio::error for samples and for an anisotropic
/// material.
[[nodiscard]] gonio::brdf_table read_table(const std::filesystem::path& path, gonio::thread_count threads = {});

/// A complete material: a table, which is isotropic, or an anisotropic BRDF.
using any_material = std::variant<gonio::brdf_table, gonio::model::adaptive_brdf, gonio::model::angle_grid_brdf>;

/// Reads a complete material like `read_table`, but accepts an anisotropic one, and a table of Zemax.
[[nodiscard]] any_material read_material(const std::filesystem::path& path, gonio::thread_count threads = {});

/// Does the file hold a complete material? Looks at its extension and, where that is ambiguous, at its first bytes.
[[nodiscard]] bool holds_table(const std::filesystem::path& path);

/// Returns the kind of a file to write, from its name. Throws gonio::error naming the possible kinds.
[[nodiscard]] const file_kind& written_kind(const std::filesystem::path& path);

/// Writes a file of the kind that its name implies.
void write_file(const std::filesystem::path& path, const file_content& content, const writing& how = {});

/// Writes spectra (.bsdf) without the wavelengths that can be interpolated within `how.albedo_tolerance`; a warning
/// states how many are written.
void write_spectra(const std::filesystem::path& path, const gonio::spectral_table& table,
                   const std::string& description, const writing& how);

}  // namespace cli
