#pragma once
/// Tables of many materials, read a block of cells at a time from any source. In memory, 10,000 materials on MERL's
/// grid would take 130 GB.

#include <gonio/core/parallel.hpp>
#include <gonio/table/material_set.hpp>

#include <Eigen/Core>

#include <functional>
#include <string>
#include <vector>

namespace gonio {

/// The destination of a block of cells: each row is contiguous; the rows may be any distance apart.
using cell_rows = Eigen::Ref<cell_matrix, 0, Eigen::OuterStride<>>;

/// Named materials over common cells. `read(range, out)` writes the values of a block of cells, in sr^-1, into `out`: a
/// row for each cell, with all channels of the first material before those of the next. `read` is called from several
/// threads at once, and may be called repeatedly for the same cells.
struct material_rows {
  valid_cells cells;
  std::vector<std::string> names;
  std::function<void(block range, cell_rows out)> read;
  std::vector<double> wavelengths =
      {};  ///< wavelengths of each material's channels, nanometres, ascending; empty for red, green and blue

  /// Returns the number of channels of each material: its wavelengths, or three.
  [[nodiscard]] Eigen::Index channels() const noexcept { return channels_at<valid_cells>(wavelengths); }
  [[nodiscard]] Eigen::Index columns() const noexcept { return channels() * std::ssize(names); }
};

/// Returns the materials of a set in memory.
[[nodiscard]] material_rows rows_of(material_set materials);

/// Returns the materials at these positions, in this order. Reading a subset reads every material. Throws gonio::error
/// for an invalid position.
[[nodiscard]] material_rows subset(const material_rows& materials, const std::vector<Eigen::Index>& chosen);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/table/impl/material_rows.ipp>
#endif
