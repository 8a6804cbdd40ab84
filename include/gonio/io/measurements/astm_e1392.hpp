#pragma once
/// Measurements in the text format of ASTM E1392 as files have it that Cornell's Program of Computer Graphics publishes
/// (www.graphics.cornell.edu/online/measurements/reflectance): lines of a keyword and its value, of which `VARS` names
/// the columns and ends the header, then a line of comma-separated numbers for each pair of directions. The standard
/// itself (withdrawn) is not public; the layout is that of two readers of such files, libbsdf's AstmReader by Kimura
/// Ryo (github.com/KimuraRyo/libbsdf) and the ASTMBRDFParser of the Rochester Institute of Technology, which agree.

#include <gonio/io/text/text.hpp>
#include <gonio/table/sample_set.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace gonio::io {

/// Does the text begin as such a file does: is one of the first 4096 bytes' lines `VARS theta_i,...`?
[[nodiscard]] bool looks_like_astm_e1392(std::string_view text);

/// Samples from the text of such a file; `name` is what errors call it. The columns are `theta_i`, `phi_i`, `theta_s`
/// and `phi_s` in radians, in any order, and values in sr^-1 without the cosine: `R`, `G`, `B` (linear), or `X`, `Y`,
/// `Z` (under D65), or wavelengths (`400nm`, ascending), or a single one of any name. Throws
/// gonio::error naming line and column of what is wrong, or if there are other than `NUM_POINTS` lines.
[[nodiscard]] sample_set read_astm_e1392(std::string_view text, const std::string& name);

/// Reads such a file.
[[nodiscard]] sample_set read_astm_e1392(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/astm_e1392.ipp>
#endif
