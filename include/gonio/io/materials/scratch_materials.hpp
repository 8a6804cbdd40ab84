#pragma once
/// Tables of many materials, each appended once and read a block of cells at a time. Tables stay in memory while they
/// fit, then go to an unnamed scratch file, which vanishes with its process. A table takes 4 bytes per cell and
/// channel: 13 MB for a material in RGB on MERL's grid (33 MB in a MERL file), and 136 MB at 31 wavelengths.

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
  /// Keeps the scratch file in `folder`. Tables in memory are written to it before they exceed `memory` bytes.
  explicit scratch_materials(std::filesystem::path folder, std::uint64_t memory = std::uint64_t{512} << 20);

  /// Throws gonio::error if the table's cells or wavelengths differ from those of the first table, or if the folder's
  /// disk is full.
  void append(const std::string& name, const brdf_table& table);
  void append(const std::string& name, spectral_table table);
  /// Appends a row of values for each cell, at some wavelengths or, if there are none, in RGB.
  void append(const std::string& name, const valid_cells& cells, std::vector<double> wavelengths, cell_matrix values);

  /// Returns all appended materials, which share tables and file with this object: append none afterwards. Throws
  /// gonio::error if there is none; reading the materials throws if the file cannot be read.
  [[nodiscard]] material_rows rows();

  /// Returns the size of the scratch file in bytes: 0 while all tables are in memory.
  [[nodiscard]] std::uint64_t file_size() const noexcept;

 private:
  struct state;
  std::shared_ptr<state> state_;
};

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/materials/impl/scratch_materials.ipp>
#endif
