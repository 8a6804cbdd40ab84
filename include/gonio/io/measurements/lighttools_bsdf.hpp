#pragma once
/// Measurements in the BSDF files of LightTools (Synopsys), text in the layout that libbsdf by Kimura Ryo
/// (github.com/KimuraRyo/libbsdf) reads: a header with azimuths and polar angles of the viewer, then a block for each
/// angle of incidence, side of the sample, kind of scatter and wavelength or tristimulus value. A block has a row for
/// each azimuth and a column for each polar angle. Azimuths belong to a light at azimuth 90; the mirror direction is at
/// azimuth 270. Values are sr^-1 without the cosine.

#include <gonio/io/text/text.hpp>
#include <gonio/table/sample_set.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace gonio::io {

/// Does the text begin like a LightTools BSDF file? Zemax's files have the same keywords, but no keyword of a block
/// follows their DataBegin.
[[nodiscard]] bool looks_like_lighttools_bsdf(std::string_view text);

/// Reads samples from the text of a LightTools BSDF file: the reflection of the front, or of the back if the front has
/// none. Values are grey, spectra if blocks have several wavelengths, or CIE XYZ under D65. If a table has only half of
/// the azimuths because of symmetry about the plane of incidence, only that half is read. Throws gonio::error naming
/// the faulty line, if there is no reflection, and for planes of incidence (POI) other than 0: the descriptions of the
/// layout do not say how such planes turn the directions. Errors call the file `name`.
[[nodiscard]] sample_set read_lighttools_bsdf(std::string_view text, const std::string& name);

/// Reads a LightTools BSDF file.
[[nodiscard]] sample_set read_lighttools_bsdf(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/lighttools_bsdf.ipp>
#endif
