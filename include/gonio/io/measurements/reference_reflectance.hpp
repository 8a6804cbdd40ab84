#pragma once
/// The reflectance of a white reference as a function of the angles of light and viewer, as CSV
/// (docs/reference/formats.md).

#include <gonio/capture/reference_reflectance.hpp>

#include <filesystem>

namespace gonio::io {

/// Reads a table in any dialect (io/text/csv_dialect.hpp). The header names the columns, in any order: `theta_i`,
/// optionally `theta_o` (degrees, or with a unit as in files of samples), and `factor` or `factor_r,factor_g,factor_b`
/// (or per cent, `factor [%]`). Lines ascend by theta_i, then by theta_o; every theta_i has the same values of theta_o.
///
/// Throws gonio::error naming the file and, where possible, the line: if a column is missing or unknown, a number is
/// invalid, angles do not ascend, a pair of angles is missing, or `reference_reflectance` refuses the table.
[[nodiscard]] capture::reference_reflectance read_reference_reflectance(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/reference_reflectance.ipp>
#endif
