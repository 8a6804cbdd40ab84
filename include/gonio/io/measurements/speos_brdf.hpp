#pragma once
/// Text files of Ansys Speos (Spectral BSDF, Complete Scattering; Anisotropic BSDF), as the pages "Structure of BRDF
/// files" and "Structure of Anisotropic BSDF files" of its help describe them (ansyshelp.ansys.com, Optis_UG_LAB,
/// structure_of_brdf_files_81027 and structure_of_anisotropic_bsdf_files_81025): `.brdf`, for each angle of incidence
/// and each wavelength the reflectance and a table over the viewer's directions; `.anisotropicbsdf`, one spectrum of
/// the reflectance and a table for each azimuth of the light and angle of incidence.

#include <gonio/io/text/text.hpp>
#include <gonio/table/sample_set.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace gonio::io {

/// Does the text begin with the header of such a file, `OPTIS - brdf surface file` or `OPTIS - Anisotropic BSDF surface
/// file`?
[[nodiscard]] bool looks_like_speos_brdf(std::string_view text);

/// Samples from the text of such a file; `name` is what errors call it: one spectrum, sr^-1 without the cosine, for
/// each direction. Tables are proportional to the BRDF, or to it times the viewer's cosine; the reflectance, percent,
/// scales them: the BRDF times the cosine, integrated over the table's directions, is the reflectance. Azimuth 0 is the
/// mirror direction's side. The spectrum of an anisotropic file is that of one angle of incidence and scales all its
/// tables; azimuths count from its anisotropy vector. Throws gonio::error naming the line of what is wrong, of binary
/// files, files of transmission, and tables that differ in their directions from wavelength to wavelength.
[[nodiscard]] sample_set read_speos_brdf(std::string_view text, const std::string& name);

/// Reads such a file.
[[nodiscard]] sample_set read_speos_brdf(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/speos_brdf.ipp>
#endif
