#pragma once
/// Measurements in the text format of ALTA (Belcour, Barla and Pacanowski; github.com/belcour/alta), described on its
/// page "Data File Formats": header lines `#DIM`, `#PARAM_IN`, `#PARAM_OUT` and `#VS`, then a line of numbers,
/// separated by blanks, for each pair of directions.

#include <gonio/io/text/text.hpp>
#include <gonio/table/sample_set.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace gonio::io {

/// Does the text have a line `#DIM` and a line `#PARAM_IN` above the first line of numbers?
[[nodiscard]] bool looks_like_alta(std::string_view text);

/// Reads samples from the text of an ALTA file. Angles are in radians. `#PARAM_IN` is one of `RUSIN_TH_TD_PD`,
/// `RUSIN_TH_PH_TD_PD`, `SPHERICAL_TL_PL_TV_PV`, `ISOTROPIC_TV_TL_DPHI`, `ISOTROPIC_TL_TV_PROJ_DPHI` and `CARTESIAN`;
/// ALTA's other parametrisations do not determine the directions. `#PARAM_OUT` is `INV_STERADIAN` (one value, sr^-1),
/// `INV_STERADIAN_COSINE_FACTOR` (times the cosine of the viewer's angle), `RGB_COLOR` (linear) or `XYZ_COLOR` (under
/// D65). Ignores confidence intervals. Throws gonio::error naming the faulty line. Errors call the file `name`.
[[nodiscard]] sample_set read_alta(std::string_view text, const std::string& name);

/// Reads an ALTA file.
[[nodiscard]] sample_set read_alta(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/alta.ipp>
#endif
