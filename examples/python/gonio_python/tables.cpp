/// Tables of BRDFs: views of their memory, and their files.

#include "brdf_methods.hpp"
#include "cells.hpp"
#include "copies.hpp"
#include "subjects.hpp"
#include <gonio/io/materials/merl_gzip.hpp>
#include <gonio/io/materials/rgl.hpp>
#include <gonio/io/materials/table_npy.hpp>
#include <gonio/model/clipped_brdf.hpp>
#include <gonio/table/tensor_view.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace python {

namespace {

/// Returns a table from an array over a whole grid. Ignores cells at which the cosine of a direction is not above 0 and
/// `minimum_cosine`.
gonio::brdf_table table_from_dense(const py::object& given, const std::string& anchor, double minimum_cosine) {
  const auto array = py::array_t<float, py::array::c_style | py::array::forcecast>::ensure(given);
  if (!array) gonio::refuse("values is not an array of numbers");
  if (array.ndim() != 4 || array.shape(3) != 3)
    gonio::refuse({"values has shape ", shape_of(array), ": expected (theta_h, theta_d, phi_d, 3)"});
  const auto extent = [&](int axis) { return static_cast<int>(std::min<py::ssize_t>(array.shape(axis), 1 << 30)); };
  gonio::brdf_table table(cells_of({extent(0), extent(1), extent(2)}, anchor, minimum_cosine));
  const float* from = array.data();
  for (Eigen::Index cell = 0; cell < table.cells().size(); ++cell)
    for (Eigen::Index c = 0; c < 3; ++c) {
      const float value = from[3 * table.cells().linear(cell) + c];
      if (!std::isfinite(value)) {
        const gonio::cell_index at = table.cells().grid().cell(table.cells().linear(cell));
        gonio::refuse({"values[", at.theta_h, ", ", at.theta_d, ", ", at.phi_d, ", ", c, "] is ",
                       std::string(py::str(py::float_(value))), ": expected finite numbers above the horizon"});
      }
      table.values()[3 * cell + c] = value;
    }
  return table;
}

py::array_t<float> values_of(const py::object& self) {
  auto& table = self.cast<gonio::brdf_table&>();
  constexpr py::ssize_t step = sizeof(float);
  return view_of(table.values().data(), {table.cells().size(), 3}, {3 * step, step}, self);
}

/// Returns an array over the whole grid. A cell below the horizon gets the value of the valid cell with the next
/// smaller theta_h, which a look-up reads there.
py::array_t<float> filled_array(const gonio::brdf_table& table) {
  const gonio::valid_cells& cells = table.cells();
  const auto [theta_h, theta_d, phi_d] = cells.grid().extents();
  py::array_t<float> array(extents{theta_h, theta_d, phi_d, 3});
  float* to = array.mutable_data();
  for (Eigen::Index linear = 0; linear < cells.grid().size(); ++linear)
    to = std::copy_n(table.values().data() + 3 * cells.representative(linear), 3, to);
  return array;
}

py::array_t<float> dense_array(const gonio::brdf_table& table) { return array_of(gonio::dense_tensor(table)); }

/// Returns the table as the array that numpy asks for.
py::object as_array(const gonio::brdf_table& table, const py::object& dtype, const py::object& copy) {
  if (!copy.is_none() && !copy.cast<bool>())
    gonio::refuse("a table as an array is always a copy: copy=False is not supported");
  const py::array_t<float> array = dense_array(table);
  return dtype.is_none() ? py::object(array) : array.attr("astype")(dtype);
}

py::tuple state_of_table(const gonio::brdf_table& table) {
  return py::make_tuple(state_of(table.cells()), array_of_numbers(table.values()));
}

gonio::brdf_table table_of_state(const py::tuple& state) {
  require_state(state, 2);
  auto table = gonio::brdf_table::uninitialised(cells_of_state(state[0].cast<py::tuple>()));
  copy_numbers(state[1], table.values().data(), std::ssize(table.values()));
  return table;
}

void add_table_class(py::module_& m) {
  py::class_<gonio::brdf_table> table(
      m, "Table",
      "A BRDF in sr^-1 over the cells of a grid in half and difference angles, as in MERL files.\n\n"
      "Only cells with both directions above the horizon are kept. Values are as measured and may be negative.");
  table.def(py::init([] { return gonio::brdf_table(gonio::valid_cells()); }),
            "Makes a table of zeros over the 90 x 90 x 180 cells of a MERL file.");
  table.def(py::init([](const gonio::valid_cells& cells) { return gonio::brdf_table(cells); }), py::arg("cells"),
            "Makes a table of zeros over some cells.");
  table.def(
      py::init(&table_from_dense), py::arg("values"), py::kw_only(), py::arg("anchor") = "centre",
      py::arg("minimum_cosine") = 0.0,
      "Makes a table from an array of shape (theta_h, theta_d, phi_d, 3), sr^-1. anchor: the position of each value\n"
      "in its cell, 'centre' or 'lower_corner'. Cells at which the cosine of a direction is not larger than\n"
      "minimum_cosine are ignored, and so are cells below the horizon.");
  table.def_property_readonly("values", &values_of,
                              "The table's own memory as an array of float32, shape (cells, 3): writing to it\n"
                              "changes the table.");
  table.def("__len__", [](const gonio::brdf_table& t) { return t.cells().size(); });
  table.def_property_readonly("cells", &gonio::brdf_table::cells, "The cells of the values.");
  table.def_property_readonly(
      "shape", [](const py::object& self) { return py::object(self.attr("cells").attr("shape")); },
      "The number of cells along theta_h, theta_d and phi_d, including those below the horizon.");
  table.def_property_readonly(
      "anchor", [](const gonio::brdf_table& t) { return word_of(t.cells().grid().anchor()); },
      "The position of each value in its cell: 'centre' or 'lower_corner'. For a file it is inferred from the cells\n"
      "without a value.");
  table.def_property_readonly(
      "minimum_cosine", [](const gonio::brdf_table& t) { return t.cells().minimum_cosine(); },
      "Cells have values if the cosines of both directions exceed this number; 0: down to the horizon.");
  table.def(
      "directions", [](const gonio::brdf_table& t) { return directions_of(t.cells()); },
      "Returns the directions of the values: shape (cells, 6), wi and wo.");
  table.def(
      "angles", [](const gonio::brdf_table& t) { return angles_of(t.cells()); },
      "Returns the angles of the values, theta_h, theta_d and phi_d, in radians: shape (cells, 3).");
  table.def(
      "dense",
      [](const gonio::brdf_table& t, bool fill) { return fill ? filled_array(t) : array_of(gonio::dense_tensor(t)); },
      py::arg("fill") = false,
      "Returns a copy of shape (theta_h, theta_d, phi_d, 3). Cells below the horizon are NaN or, with fill, have\n"
      "the value of the valid cell with the next smaller theta_h, which a look-up reads.");
  table.def("__array__", &as_array, py::arg("dtype") = py::none(), py::arg("copy") = py::none(),
            "numpy.asarray(table) is table.dense().");
  table.def(
      "__getitem__",
      [](const gonio::brdf_table& t, const py::object& index) { return dense_array(t).attr("__getitem__")(index); },
      py::arg("index"),
      "Indexes numpy.asarray(table), which is made on each call: table[theta_h, theta_d, phi_d] is red, green and\n"
      "blue. For many look-ups make the array once.");
  table.def("copy", [](const gonio::brdf_table& t) { return t; });
  table.def("__repr__", [](const gonio::brdf_table& t) { return "<gonio.Table: " + sentence_of(t.cells()) + '>'; });
  add_copies(table, &state_of_table, &table_of_state);
  add_brdf_methods(m, table);
}

/// Returns the bytes of the material's RGL file.
py::tuple state_of_adaptive(const gonio::model::adaptive_brdf& material) {
  const std::vector<std::byte> bytes = gonio::io::write_rgl(gonio::io::rgl_material{material, "", {}});
  return py::make_tuple(py::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

gonio::model::adaptive_brdf adaptive_of_state(const py::tuple& state) {
  require_state(state, 1);
  const auto text = state[0].cast<std::string>();
  return gonio::io::read_rgl(std::as_bytes(std::span(text)), "a pickle").material;
}

}  // namespace

void write_rgl(const std::filesystem::path& path, const gonio::model::adaptive_brdf& f) {
  const bool is_negative = gonio::model::count_negative_values(f, gonio::valid_cells()).cells > 0;
  gonio::io::write_rgl(path, is_negative ? gonio::model::clipped(f) : f);
}

void write_rgl(const std::filesystem::path& path, const brdf_by_pointer& f) {
  gonio::io::write_rgl(path, gonio::model::clipped_brdf(f));
}

void add_tables(py::module_& m) {
  add_table_class(m);
  py::class_<gonio::model::adaptive_brdf> adaptive(
      m, "AdaptiveBrdf",
      "A material of the RGL database: values over a parameterisation that follows its highlight (Dupuy and Jakob\n"
      "2018). It averages over both orders of the directions, because measurements are not reciprocal.");
  adaptive.def("__repr__", [](const gonio::model::adaptive_brdf&) { return "<gonio.AdaptiveBrdf>"; });
  add_copies(adaptive, &state_of_adaptive, &adaptive_of_state);
  add_brdf_methods(m, adaptive);
  m.def(
      "read_merl", [](const std::filesystem::path& path) { return gonio::io::read_merl_any(path); }, py::arg("path"),
      py::call_guard<py::gil_scoped_release>(), "Reads a MERL file (.binary), plain or compressed by gzip.");
  m.def(
      "read_rgl",
      [](const std::filesystem::path& path) { return gonio::io::colours_of(gonio::io::read_rgl(path), path); },
      py::arg("path"), py::call_guard<py::gil_scoped_release>(), "Reads a material of the RGL database (.bsdf).");
  m.def("write_npy", &gonio::io::write_table_npy, py::arg("path"), py::arg("table"),
        py::call_guard<py::gil_scoped_release>(),
        "Writes a table as a numpy file: float32, shape (theta_h, theta_d, phi_d, 3), values at the cells' centres; a\n"
        "cell below the horizon has the value of the valid cell with the next smaller theta_h.");
}

}  // namespace python
