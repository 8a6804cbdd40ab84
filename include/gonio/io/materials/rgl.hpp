#pragma once
/// Files of the RGL material database (`.bsdf`), which Mitsuba 3 and pbrt-v4 read as material "measured": isotropic and
/// anisotropic materials in RGB or spectra, in a container of named arrays ("tensor file", version 1.0). Dupuy and
/// Jakob 2018 (doi:10.1145/3272127.3275059); model/adaptive_brdf.hpp explains the arrays.
///
/// A container is the text "tensor_file" and a zero, two bytes of version, a uint32 number of arrays, and for each
/// array: a uint16 length and the name, a uint16 number of dimensions, a uint8 type, a uint64 position of its elements
/// in the file and a uint64 extent per dimension; all little-endian.

#include <gonio/core/brdf.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/text/named_files.hpp>
#include <gonio/model/adaptive_brdf.hpp>
#include <gonio/model/smooth_spectra.hpp>
#include <gonio/model/tabulate_adaptively.hpp>

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gonio::io {

namespace detail {

/// An array of a container: the code of its type, and its elements as a view into the file's bytes.
struct tensor_field {
  std::uint8_t type = 0;
  std::vector<std::uint64_t> shape;
  std::span<const std::byte> elements;
};

/// Returns the arrays of a container by name, checked against the size of the file.
[[nodiscard]] std::map<std::string, tensor_field> tensor_fields(std::span<const std::byte> bytes,
                                                                const std::string& name);

}  // namespace detail

/// The values of a material at several wavelengths, instead of its red, green and blue.
struct rgl_spectra {
  std::vector<double> wavelengths;   ///< nanometres, ascending
  model::unit_square_tables values;  ///< a table per wavelength for the first direction of the light, then the next
};

/// A material and the description in its file.
struct rgl_material {
  model::adaptive_brdf material;  ///< for spectra: linear Rec. 709 under D65; black if no wavelength is visible
  std::string description;
  std::optional<rgl_spectra> spectra;  ///< if the file has spectra instead of RGB
};

/// Reads a material from the bytes of a file. It is anisotropic if the file has more than two azimuths of the light.
/// Throws gonio::error if an array is missing or malformed. Errors call the file `name`.
[[nodiscard]] rgl_material read_rgl(std::span<const std::byte> bytes, const std::string& name);

/// Reads a file.
[[nodiscard]] inline rgl_material read_rgl(const std::filesystem::path& path) {
  return read_rgl(read_bytes(path), path.string());
}

/// Returns the colours of a material that was read. Throws gonio::error with `name` if no wavelength is visible.
[[nodiscard]] model::adaptive_brdf colours_of(rgl_material material, const std::string& name);

/// Returns spectra for an RGB material, for pbrt-v4 and spectral variants of Mitsuba.
[[nodiscard]] rgl_spectra upsampled_spectra(const model::adaptive_brdf& material,
                                            const model::smooth_spectra& spectra = {});

/// Returns the bytes of a file. A material with spectra becomes a spectral file, for pbrt-v4 and Mitsuba's spectral
/// variants; any other becomes an RGB file, for Mitsuba's RGB variants. Throws gonio::error for spectra that do not fit
/// the material, and for tables of values that are not square, which renderers refuse.
[[nodiscard]] std::vector<std::byte> write_rgl(const rgl_material& material);

/// Writes a file beside its target and renames it.
void write_rgl(const std::filesystem::path& path, const rgl_material& material);

/// Writes an `adaptive_brdf`, which has the file's tables, or any isotropic BRDF in RGB, for which
/// `tabulate_keeping_albedo` makes them.
template <brdf Brdf>
void write_rgl(const std::filesystem::path& path, const Brdf& f, const std::string& description = "gonio") {
  if constexpr (std::same_as<Brdf, model::adaptive_brdf>)
    write_rgl(path, rgl_material{f, description, {}});
  else
    write_rgl(path, rgl_material{model::tabulate_keeping_albedo(f), description, {}});
}

/// Lists the materials (`.bsdf`) in a folder; see `list_named_files`.
[[nodiscard]] std::vector<named_file> list_rgl_directory(const std::filesystem::path& folder);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/materials/impl/rgl.ipp>
#endif
