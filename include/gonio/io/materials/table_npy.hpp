#pragma once
/// Tables as arrays of numpy: float32, or half floats, of shape (theta_h, theta_d, phi_d, 3), sr^-1.

#include <gonio/io/bytes/npy.hpp>
#include <gonio/table/brdf_table.hpp>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace gonio::io {

/// Writes a table for whoever reads arrays: its values at the cells' centres, to which a table by lower corners is
/// interpolated. A cell below the horizon has the value of the one above it in theta_h that
/// is not: no hole for an interpolation to fall into. Which cells these are is geometry: see `valid_cells`.
void write_table_npy(const std::filesystem::path& path, const brdf_table& table);

/// The same as half floats. Throws gonio::error for a value that is beyond their range.
void write_table_npy_halves(const std::filesystem::path& path, const brdf_table& table);

/// A table from the bytes of such an array, whose values are those at the cells' centres; `name` is what errors call
/// it. Throws gonio::error for another shape and values that are not finite.
[[nodiscard]] brdf_table read_table_npy(std::span<const std::byte> bytes, const std::string& name);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/materials/impl/table_npy.ipp>
#endif
