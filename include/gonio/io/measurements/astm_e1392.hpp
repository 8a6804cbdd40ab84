#pragma once
/// Measurements in the text format of ASTM E1392, as in the files of Cornell's Program of Computer Graphics
/// (www.graphics.cornell.edu/online/measurements/reflectance): lines of a keyword and its value; the last one, `VARS`,
/// names the columns; then a line of comma-separated numbers for each pair of directions. The standard itself
/// (withdrawn) is not public. The layout is that of two other readers, which agree: libbsdf's AstmReader by Kimura Ryo
/// (github.com/KimuraRyo/libbsdf) and the ASTMBRDFParser of the Rochester Institute of Technology.

#include <gonio/io/text/text.hpp>
#include <gonio/table/sample_set.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace gonio::io {

/// Does the text have a line `VARS theta_i,...` in its first 4096 bytes?
[[nodiscard]] bool looks_like_astm_e1392(std::string_view text);

/// Reads samples from the text of an ASTM E1392 file. The columns, in any order, are `theta_i`, `phi_i`, `theta_s` and
/// `phi_s` in radians, and values in sr^-1 without the cosine: `R`, `G`, `B` (linear), `X`, `Y`, `Z` (under D65),
/// wavelengths (`400nm`, ascending), or one column of any name. Throws gonio::error naming the faulty line and column,
/// and if the number of lines is not `NUM_POINTS`. Errors call the file `name`.
[[nodiscard]] sample_set read_astm_e1392(std::string_view text, const std::string& name);

/// Reads an ASTM E1392 file.
[[nodiscard]] sample_set read_astm_e1392(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/astm_e1392.ipp>
#endif
