#pragma once
/// Tabulated BSDF of FRED (Photon Engineering), text as written by the scripts of github.com/ua-loft/bsdf-tools, with
/// the angles of the page "Tabulated BSDF" of FRED's help: a line `type bsdf_data`, a line `format ...`, then blocks. A
/// block has a line with the light's two angles, and lines with two angles of the viewer and a value.

#include <gonio/io/text/text.hpp>
#include <gonio/table/sample_set.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace gonio::io {

/// Is the first line `type bsdf_data`?
[[nodiscard]] bool looks_like_fred_bsdf(std::string_view text);

/// Reads samples from the text of a FRED BSDF file: one value, sr^-1 without the cosine. Angles are polar angle and
/// azimuth in degrees; if the azimuths are equal, the viewer is on the side of the mirror direction. Throws
/// gonio::error naming the faulty line, and for formats other than `angles=deg bsdf=value scale=1`. Errors call the
/// file `name`.
[[nodiscard]] sample_set read_fred_bsdf(std::string_view text, const std::string& name);

/// Reads a FRED BSDF file.
[[nodiscard]] sample_set read_fred_bsdf(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/fred_bsdf.ipp>
#endif
