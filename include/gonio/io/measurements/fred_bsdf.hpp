#pragma once
/// Tabulated BSDF of FRED (Photon Engineering), text, as the scripts of github.com/ua-loft/bsdf-tools write it and the
/// page "Tabulated BSDF" of FRED's help describes its angles: a line `type bsdf_data`, a line `format ...`, then
/// blocks: a line of the light's two angles, and a line of the viewer's two angles and a value for each viewer.

#include <gonio/io/text/text.hpp>
#include <gonio/table/sample_set.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace gonio::io {

/// Is the first line `type bsdf_data`?
[[nodiscard]] bool looks_like_fred_bsdf(std::string_view text);

/// Samples from the text of such a file; `name` is what errors call it: one value, sr^-1 without the cosine. Angles are
/// polar angle and azimuth in degrees; where azimuths are equal, the viewer is on the mirror direction's side. Throws
/// gonio::error naming the line of what is wrong, and of another format than `angles=deg bsdf=value scale=1`.
[[nodiscard]] sample_set read_fred_bsdf(std::string_view text, const std::string& name);

/// Reads such a file.
[[nodiscard]] sample_set read_fred_bsdf(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/fred_bsdf.ipp>
#endif
