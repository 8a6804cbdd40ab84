#pragma once
/// Files of the RGL material database (`.bsdf`), which Mitsuba 3 and pbrt-v4 read as material "measured": isotropic
/// materials in RGB or in spectra, held in a container of named arrays ("tensor file", version 1.0). Dupuy and Jakob
/// 2018 (doi:10.1145/3272127.3275059); see model/adaptive_brdf.hpp for what the arrays are.
///
/// A container is the text "tensor_file" and a zero, two bytes of version, a uint32 with the number of arrays, and for
/// each of them: a uint16 length and the name, a uint16 number of dimensions, a uint8 type, a uint64 position of its
/// elements in the file and a uint64 extent for each dimension; all little-endian.

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

/// An array of a container: its type's code, and its elements where they are in the file's bytes.
struct tensor_field {
  std::uint8_t type = 0;
  std::vector<std::uint64_t> shape;
  std::span<const std::byte> elements;
};

/// The arrays of a container by name, checked against the bytes that there are.
[[nodiscard]] std::map<std::string, tensor_field> tensor_fields(std::span<const std::byte> bytes,
                                                                const std::string& name);

}  // namespace detail

/// The values of a material at several wavelengths, in the place of its red, green and blue.
struct rgl_spectra {
  std::vector<double> wavelengths;   ///< nanometres, ascending; w of them
  model::unit_square_tables values;  ///< w n tables for n theta_i, all wavelengths of the first theta_i first
};

/// A material, and what its file says of it.
struct rgl_material {
  model::adaptive_brdf material;  ///< of spectra their linear Rec. 709 colour under D65; black if none is visible
  std::string description;
  std::optional<rgl_spectra> spectra;  ///< if the file has them instead of RGB
};

/// A material from the bytes of a file; `name` is what errors call it. Throws gonio::error if an array is missing or
/// malformed and for an anisotropic material (more than two azimuths of the light).
[[nodiscard]] rgl_material read_rgl(std::span<const std::byte> bytes, const std::string& name);

/// Reads a file.
[[nodiscard]] inline rgl_material read_rgl(const std::filesystem::path& path) {
  return read_rgl(read_bytes(path), path.string());
}

/// The colours of a material that was read. Throws gonio::error saying that `name` has none where no wavelength is
/// visible.
[[nodiscard]] model::adaptive_brdf colours_of(rgl_material material, const std::string& name);

/// Spectra for a material that is known in RGB, for pbrt-v4 and spectral variants of Mitsuba.
[[nodiscard]] rgl_spectra upsampled_spectra(const model::adaptive_brdf& material,
                                            const model::smooth_spectra& spectra = {});

/// The bytes of a file. Of spectra, if there are any, the spectral variant, which pbrt-v4 and Mitsuba's spectral
/// variants want; otherwise that of Mitsuba's RGB variants. Throws gonio::error for spectra that do not fit the
/// material, and for a material whose values are in tables that are not square, which renderers refuse.
[[nodiscard]] std::vector<std::byte> write_rgl(const rgl_material& material);

/// Writes a file beside its target and renames it.
void write_rgl(const std::filesystem::path& path, const rgl_material& material);

/// The same of any BRDF, in RGB: `tabulate_keeping_albedo` makes its tables, unless it has some.
template <brdf Brdf>
void write_rgl(const std::filesystem::path& path, const Brdf& f, const std::string& description = "gonio") {
  if constexpr (std::same_as<Brdf, model::adaptive_brdf>)
    write_rgl(path, rgl_material{f, description, {}});
  else
    write_rgl(path, rgl_material{model::tabulate_keeping_albedo(f), description, {}});
}

/// The materials (`.bsdf`) in a folder; see `list_named_files`.
[[nodiscard]] std::vector<named_file> list_rgl_directory(const std::filesystem::path& folder);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/materials/impl/rgl.ipp>
#endif
