#pragma once
/// Tables as numpy arrays: float32 or half floats of shape (theta_h, theta_d, phi_d, 3), sr^-1.

#include <gonio/io/bytes/npy.hpp>
#include <gonio/table/brdf_table.hpp>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace gonio::io {

/// Writes a table for programs that read arrays: its values at the cells' centres; a table with values at lower corners
/// is interpolated. A cell below the horizon gets the value of the next one above the horizon in theta_h, so that
/// interpolation meets no holes. `valid_cells` tells which cells are below the horizon, from geometry.
void write_table_npy(const std::filesystem::path& path, const brdf_table& table);

/// Writes half floats. Throws gonio::error for a value outside their range.
void write_table_npy_halves(const std::filesystem::path& path, const brdf_table& table);

/// Reads a table from the bytes of such an array, whose values are at the cells' centres. Errors call it `name`. Throws
/// gonio::error for another shape and for values that are not finite.
[[nodiscard]] brdf_table read_table_npy(std::span<const std::byte> bytes, const std::string& name);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/materials/impl/table_npy.ipp>
#endif
