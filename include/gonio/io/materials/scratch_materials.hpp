#pragma once
/// Tables of many materials, each appended once and read a block of cells at a time. They are kept in memory while they
/// fit, then in a scratch file without a name, which vanishes with its process. Each takes 4 bytes per cell and
/// channel: 13 MB for a material in RGB on MERL's grid (whose own file has 33 MB), and 136 MB at 31 wavelengths.

#include <gonio/table/brdf_table.hpp>
#include <gonio/table/material_rows.hpp>
#include <gonio/table/spectral_table.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace gonio::io {

class scratch_materials {
 public:
  /// Keeps the scratch file in `folder`; writes tables to it when they fill `memory` bytes, at least one at a time.
  explicit scratch_materials(std::filesystem::path folder, std::uint64_t memory = std::uint64_t{512} << 20);

  /// Throws gonio::error if the table has other cells or wavelengths than the first one, or the folder is full.
  void append(const std::string& name, const brdf_table& table);
  void append(const std::string& name, spectral_table table);
  /// Appends a row of values for each cell, at some wavelengths or, if there are none, in RGB.
  void append(const std::string& name, const valid_cells& cells, std::vector<double> wavelengths, cell_matrix values);

  /// Returns all appended materials. They share tables and file with this object, which must not be appended to
  /// afterwards. Throws gonio::error if there is none; reading throws if the file cannot be read.
  [[nodiscard]] material_rows rows();

  /// Returns the size of the file in bytes: 0 while all tables are in memory.
  [[nodiscard]] std::uint64_t file_size() const noexcept;

 private:
  struct state;
  std::shared_ptr<state> state_;
};

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/materials/impl/scratch_materials.ipp>
#endif
