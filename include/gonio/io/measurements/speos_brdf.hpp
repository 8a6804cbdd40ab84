#pragma once
/// Text files of Ansys Speos (Spectral BSDF, Complete Scattering; Anisotropic BSDF), as described on the pages
/// "Structure of BRDF files" and "Structure of Anisotropic BSDF files" of its help (ansyshelp.ansys.com, Optis_UG_LAB,
/// structure_of_brdf_files_81027 and structure_of_anisotropic_bsdf_files_81025). `.brdf`: the reflectance and a table
/// over the viewer's directions, for each angle of incidence and wavelength. `.anisotropicbsdf`: one spectrum of the
/// reflectance, and a table for each azimuth of the light and angle of incidence.

#include <gonio/io/text/text.hpp>
#include <gonio/table/sample_set.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace gonio::io {

/// Does the text begin with the header `OPTIS - brdf surface file` or `OPTIS - Anisotropic BSDF surface file`?
[[nodiscard]] bool looks_like_speos_brdf(std::string_view text);

/// Reads samples from the text of a Speos file: a spectrum for each direction, sr^-1 without the cosine. Tables are
/// proportional to the BRDF, or to the BRDF times the viewer's cosine. The reflectance in percent scales a table: it is
/// the integral of the BRDF times the cosine over the table's directions. Azimuth 0 is the side of the mirror
/// direction. The spectrum of an anisotropic file belongs to one angle of incidence and scales all tables; azimuths
/// are counted from the file's anisotropy vector. Throws gonio::error naming the faulty line, for binary files, for
/// transmission, and if the directions differ between wavelengths. Errors call the file `name`.
[[nodiscard]] sample_set read_speos_brdf(std::string_view text, const std::string& name);

/// Reads a Speos file.
[[nodiscard]] sample_set read_speos_brdf(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/speos_brdf.ipp>
#endif
