#pragma once
/// Tables as numpy arrays: float32 or half floats of shape (theta_h, theta_d, phi_d, 3), sr^-1.

#include <gonio/io/bytes/npy.hpp>
#include <gonio/table/brdf_table.hpp>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace gonio::io {

/// Writes a table's values at the cells' centres, for programs that read arrays. A table with values at lower corners
/// is interpolated. A cell below the horizon gets the value of the valid cell with the next smaller theta_h:
/// interpolation then meets no holes. The array does not mark such cells; `valid_cells` finds them by geometry.
void write_table_npy(const std::filesystem::path& path, const brdf_table& table);

/// Writes half floats instead of float32, but is otherwise like `write_table_npy`. Throws gonio::error for a value
/// outside the range of half floats.
void write_table_npy_halves(const std::filesystem::path& path, const brdf_table& table);

/// Reads a table from the bytes of a .npy file with an array of this shape, whose values are at the cells' centres.
/// Throws gonio::error for another shape and for values that are not finite. Errors call the file `name`.
[[nodiscard]] brdf_table read_table_npy(std::span<const std::byte> bytes, const std::string& name);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/materials/impl/table_npy.ipp>
#endif
