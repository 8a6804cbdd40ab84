#pragma once
/// Cells of grids: Python's words for the anchor of their values, and their state in a pickle.

#include "arrays.hpp"
#include <gonio/table/valid_cells.hpp>

#include <string>

namespace python {

/// Returns "centre" or "lower_corner".
[[nodiscard]] const char* word_of(gonio::cell_anchor anchor);

/// Returns the anchor for "centre" or "lower_corner". Throws gonio::error for any other word.
[[nodiscard]] gonio::cell_anchor anchor_of(const std::string& word);

/// Returns the cells of a grid at which both cosines are larger than `minimum_cosine`. Throws gonio::error unless
/// `minimum_cosine` is at least 0 and less than 1.
[[nodiscard]] gonio::valid_cells cells_of(const gonio::grid_extents& shape, const std::string& anchor,
                                          double minimum_cosine);

/// Convert cells to a pickle's state, and back.
[[nodiscard]] py::tuple state_of(const gonio::valid_cells& cells);
[[nodiscard]] gonio::valid_cells cells_of_state(const py::tuple& state);

/// Returns "90 x 90 x 180 cells, values at their centre".
[[nodiscard]] std::string sentence_of(const gonio::valid_cells& cells);

/// Return the directions of the nodes, shape (cells, 6), and their angles, shape (cells, 3).
[[nodiscard]] py::array_t<double> directions_of(const gonio::valid_cells& cells);
[[nodiscard]] py::array_t<double> angles_of(const gonio::valid_cells& cells);

}  // namespace python
