#pragma once
/// Tables of many materials, each appended once and read a block of cells at a time: in memory while they fit, then in
/// a scratch file that has no name and vanishes with its process. It takes 4 bytes a cell and channel: 13 MB for a
/// material in colours on MERL's grid, whose own file has 33, and 136 MB for one at 31 wavelengths.

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
  /// The file is in `folder`; tables are written to it when `memory` bytes of them have come, at least one at a time.
  explicit scratch_materials(std::filesystem::path folder, std::uint64_t memory = std::uint64_t{512} << 20);

  /// Throws gonio::error if the table is over other cells than the first one, or at other wavelengths, or the folder
  /// cannot hold it.
  void append(const std::string& name, const brdf_table& table);
  void append(const std::string& name, spectral_table table);
  /// The same of a row of values for each cell, at some wavelengths or, without any, in colours.
  void append(const std::string& name, const valid_cells& cells, std::vector<double> wavelengths, cell_matrix values);

  /// All that were appended. Shares the tables and the file with this object, which must not be appended to afterwards.
  /// Throws gonio::error if there is none; reading does if the file cannot be read.
  [[nodiscard]] material_rows rows();

  /// Bytes in the file: 0 while all tables are in memory.
  [[nodiscard]] std::uint64_t file_size() const noexcept;

 private:
  struct state;
  std::shared_ptr<state> state_;
};

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/materials/impl/scratch_materials.ipp>
#endif
