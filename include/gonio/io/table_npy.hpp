#pragma once
/// Tables as arrays of numpy: float32 of shape (theta_h, theta_d, phi_d, 3), sr^-1.

#include <gonio/io/npy.hpp>
#include <gonio/table/brdf_table.hpp>

#include <filesystem>

namespace gonio::io {

/// Writes a table for whoever reads arrays. A cell below the horizon has the value of the one above it in theta_h that
/// is not: no hole for an interpolation to fall into. Which cells these are is geometry: see `valid_cells`.
void write_table_npy(const std::filesystem::path& path, const brdf_table& table);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/impl/table_npy.ipp>
#endif
