/// Cells of tables and priors.

#include "cells.hpp"

#include "copies.hpp"
#include "subjects.hpp"
#include <gonio/core/error.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace python {

namespace {

constexpr std::array<const char*, 2> anchor_words{"centre", "lower_corner"};  // in the order of gonio::cell_anchor

py::tuple shape_of_grid(const gonio::valid_cells& cells) {
  const auto [theta_h, theta_d, phi_d] = cells.grid().extents();
  return py::make_tuple(theta_h, theta_d, phi_d);
}

/// Returns for each cell of the grid the index of the cell that a look-up reads there.
py::array_t<std::int32_t> numbers_of(const gonio::valid_cells& cells) {
  const auto [theta_h, theta_d, phi_d] = cells.grid().extents();
  py::array_t<std::int32_t> numbers(extents{theta_h, theta_d, phi_d});
  std::int32_t* to = numbers.mutable_data();
  for (Eigen::Index linear = 0; linear < cells.grid().size(); ++linear)
    *to++ = static_cast<std::int32_t>(cells.representative(linear));
  return numbers;
}

}  // namespace

const char* word_of(gonio::cell_anchor anchor) { return anchor_words[static_cast<std::size_t>(anchor)]; }

gonio::cell_anchor anchor_of(const std::string& word) {
  for (const auto anchor : {gonio::cell_anchor::centre, gonio::cell_anchor::lower_corner})
    if (word == word_of(anchor)) return anchor;
  gonio::refuse({"anchor is '", word, "': expected 'centre' or 'lower_corner'"});
}

gonio::valid_cells cells_of(const gonio::grid_extents& shape, const std::string& anchor, double minimum_cosine) {
  if (!(minimum_cosine >= 0.0 && minimum_cosine < 1.0))
    gonio::refuse({"minimum_cosine is ", std::string(py::str(py::float_(minimum_cosine))),
                   ": expected at least 0 and less than 1"});
  return gonio::valid_cells(gonio::grid(shape, anchor_of(anchor)), minimum_cosine);
}

py::tuple state_of(const gonio::valid_cells& cells) {
  return py::make_tuple(shape_of_grid(cells), word_of(cells.grid().anchor()), cells.minimum_cosine());
}

gonio::valid_cells cells_of_state(const py::tuple& state) {
  require_state(state, 3);
  const auto shape = state[0].cast<py::tuple>();
  require_state(shape, 3);
  return cells_of({shape[0].cast<int>(), shape[1].cast<int>(), shape[2].cast<int>()}, state[1].cast<std::string>(),
                  state[2].cast<double>());
}

std::string sentence_of(const gonio::valid_cells& cells) {
  const auto [theta_h, theta_d, phi_d] = cells.grid().extents();
  return gonio::message_of({theta_h, " x ", theta_d, " x ", phi_d, " cells, values at their ",
                            cells.grid().anchor() == gonio::cell_anchor::centre ? "centre" : "lower corner"});
}

py::array_t<double> directions_of(const gonio::valid_cells& cells) {
  std::vector<gonio::direction_pair> pairs;
  pairs.reserve(static_cast<std::size_t>(cells.size()));
  for (Eigen::Index cell = 0; cell < cells.size(); ++cell) pairs.push_back(gonio::to_directions(cells.angles(cell)));
  return array_of(pairs);
}

py::array_t<double> angles_of(const gonio::valid_cells& cells) {
  py::array_t<double> angles({cells.size(), Eigen::Index{3}});
  double* to = angles.mutable_data();
  for (Eigen::Index cell = 0; cell < cells.size(); ++cell) {
    const auto [theta_h, theta_d, phi_d] = cells.angles(cell);
    *to++ = theta_h;
    *to++ = theta_d;
    *to++ = phi_d;
  }
  return angles;
}

void add_cells(py::module_& m) {
  py::class_<gonio::valid_cells> type(
      m, "Cells",
      "The cells of a grid in half and difference angles at which both directions are above the horizon. They are\n"
      "numbered in the order of an array of shape (theta_h, theta_d, phi_d).");
  type.def("__len__", &gonio::valid_cells::size, "The number of cells above the horizon.");
  type.def("__eq__", [](const gonio::valid_cells& a, const gonio::valid_cells& b) { return a == b; });
  type.def("__repr__", [](const gonio::valid_cells& cells) { return "<gonio.Cells: " + sentence_of(cells) + '>'; });
  type.def_property_readonly("shape", &shape_of_grid,
                             "The number of cells along theta_h, theta_d and phi_d, including those below the\n"
                             "horizon.");
  type.def_property_readonly(
      "anchor", [](const gonio::valid_cells& cells) { return word_of(cells.grid().anchor()); },
      "The position of a value in its cell: 'centre' or 'lower_corner'.");
  type.def_property_readonly(
      "minimum_cosine", &gonio::valid_cells::minimum_cosine,
      "Cells have values if the cosines of both directions exceed this number; 0: down to the horizon.");
  type.def(
      "directions", [](const gonio::valid_cells& cells) { return directions_of(cells); },
      "Returns the directions of the values: shape (cells, 6), wi and wo.");
  type.def(
      "angles", [](const gonio::valid_cells& cells) { return angles_of(cells); },
      "Returns the angles of the values, theta_h, theta_d and phi_d, in radians: shape (cells, 3).");
  type.def("numbers", &numbers_of,
           "Returns for each cell of the grid the number of the cell that a look-up reads there, int32 of the\n"
           "grid's shape. Below the horizon, this is the valid cell with the next smaller theta_h.\n"
           "`prior.mean[prior.cells.numbers()]` is the "
           "mean over the whole grid.");
  add_copies(
      type, [](const gonio::valid_cells& cells) { return state_of(cells); },
      [](const py::tuple& state) { return cells_of_state(state); });
}

}  // namespace python
