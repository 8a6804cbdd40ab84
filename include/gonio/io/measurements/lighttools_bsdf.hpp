#pragma once
/// Measurements in the BSDF files of LightTools (Synopsys), text, in the layout that libbsdf by Kimura Ryo
/// (github.com/KimuraRyo/libbsdf) reads: a header of azimuths and polar angles of the viewer, then a block for each
/// angle of incidence, side of the sample, kind of scatter and wavelength or tristimulus value: a row of numbers for
/// each azimuth, a column for each polar angle. Azimuths are those of a light at azimuth 90; the mirror direction is at
/// azimuth 270. Values are sr^-1 without the cosine.

#include <gonio/io/text/text.hpp>
#include <gonio/table/sample_set.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace gonio::io {

/// Does the text begin as such a file does? Zemax's files have the same keywords; in these, DataBegin is followed by
/// the keywords of a block.
[[nodiscard]] bool looks_like_lighttools_bsdf(std::string_view text);

/// Samples from the text of such a file; `name` is what errors call it: the reflection of the front, or of the back
/// where there is none. Values are grey, spectra where blocks have several wavelengths, or CIE XYZ under D65. Half of a
/// table that is symmetric about the plane of incidence stays the half that was measured. Throws gonio::error naming
/// the line of what is wrong, where there is no reflection, and of planes of incidence (POI) other than 0: whoever
/// describes the layout does not say how they turn.
[[nodiscard]] sample_set read_lighttools_bsdf(std::string_view text, const std::string& name);

/// Reads such a file.
[[nodiscard]] sample_set read_lighttools_bsdf(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/lighttools_bsdf.ipp>
#endif
