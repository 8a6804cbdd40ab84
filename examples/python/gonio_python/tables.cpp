/// Tables of BRDFs: views of their memory, and their files.

#include "brdf_methods.hpp"
#include "subjects.hpp"
#include <gonio/io/materials/merl_gzip.hpp>
#include <gonio/io/materials/rgl.hpp>
#include <gonio/io/materials/table_npy.hpp>
#include <gonio/table/tensor_view.hpp>

#include <cmath>
#include <string>

namespace python {

namespace {

/// Cells below the horizon are not looked at.
gonio::brdf_table table_from_dense(const py::object& given) {
  const auto array = py::array_t<float, py::array::c_style | py::array::forcecast>::ensure(given);
  if (!array) gonio::refuse("values is no array of numbers");
  if (array.ndim() != 4 || array.shape(3) != 3)
    gonio::refuse({"values has shape ", shape_of(array), ": expected (theta_h, theta_d, phi_d, 3)"});
  const auto extent = [&](int axis) { return static_cast<int>(std::min<py::ssize_t>(array.shape(axis), 1 << 30)); };
  gonio::brdf_table table(gonio::valid_cells(gonio::grid({extent(0), extent(1), extent(2)})));
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

py::array_t<double> directions_of_cells(const gonio::brdf_table& table) {
  std::vector<gonio::direction_pair> pairs;
  pairs.reserve(static_cast<std::size_t>(table.cells().size()));
  for (Eigen::Index cell = 0; cell < table.cells().size(); ++cell)
    pairs.push_back(gonio::to_directions(table.cells().angles(cell)));
  return array_of(pairs);
}

py::array_t<double> angles_of_cells(const gonio::brdf_table& table) {
  py::array_t<double> angles({table.cells().size(), Eigen::Index{3}});
  double* to = angles.mutable_data();
  for (Eigen::Index cell = 0; cell < table.cells().size(); ++cell) {
    const auto [theta_h, theta_d, phi_d] = table.cells().angles(cell);
    *to++ = theta_h;
    *to++ = theta_d;
    *to++ = phi_d;
  }
  return angles;
}

void add_table_class(py::module_& m) {
  py::class_<gonio::brdf_table> table(
      m, "Table",
      "A BRDF in sr^-1 over the cells of a grid in half and difference angles, as MERL files have it.\n\n"
      "Only cells with both directions above the horizon are kept. Values are as measured and may be negative.");
  table.def(py::init([] { return gonio::brdf_table(gonio::valid_cells()); }),
            "A table of zeros over the 90 x 90 x 180 cells of a MERL file.");
  table.def(py::init(&table_from_dense), py::arg("values"),
            "From an array of shape (theta_h, theta_d, phi_d, 3). Cells below the horizon are not looked at.");
  table.def_property_readonly("values", &values_of,
                              "The table's own memory as an array of float32, shape (cells, 3): what is written there\n"
                              "is in the table.");
  table.def("__len__", [](const gonio::brdf_table& t) { return t.cells().size(); });
  table.def_property_readonly(
      "shape",
      [](const gonio::brdf_table& t) {
        const auto [theta_h, theta_d, phi_d] = t.cells().grid().extents();
        return py::make_tuple(theta_h, theta_d, phi_d);
      },
      "Cells of the grid along theta_h, theta_d and phi_d, those below the horizon included.");
  table.def("directions", &directions_of_cells,
            "The directions at which the values were taken: shape (cells, 6), wi and wo.");
  table.def("angles", &angles_of_cells, "The same as theta_h, theta_d and phi_d in radians: shape (cells, 3).");
  table.def(
      "dense", [](const gonio::brdf_table& t) { return array_of(gonio::dense_tensor(t)); },
      "A copy of shape (theta_h, theta_d, phi_d, 3), NaN below the horizon.");
  table.def("copy", [](const gonio::brdf_table& t) { return t; });
  add_brdf_methods(m, table);
}

}  // namespace

void add_tables(py::module_& m) {
  add_table_class(m);
  py::class_<gonio::model::adaptive_brdf> adaptive(
      m, "AdaptiveBrdf",
      "A material of the RGL database: values over a parameterisation that follows its highlight (Dupuy and Jakob\n"
      "2018). The mean of both orders of the directions, as measurements are not reciprocal.");
  add_brdf_methods(m, adaptive);
  m.def(
      "read_merl", [](const std::filesystem::path& path) { return gonio::io::read_merl_any(path); }, py::arg("path"),
      py::call_guard<py::gil_scoped_release>(), "Reads a MERL file (.binary), also one that gzip compressed.");
  m.def(
      "read_rgl",
      [](const std::filesystem::path& path) { return gonio::io::colours_of(gonio::io::read_rgl(path), path); },
      py::arg("path"), py::call_guard<py::gil_scoped_release>(), "Reads a material of the RGL database (.bsdf).");
  m.def("write_npy", &gonio::io::write_table_npy, py::arg("path"), py::arg("table"),
        py::call_guard<py::gil_scoped_release>(),
        "Writes a table as numpy's own file: float32, shape (theta_h, theta_d, phi_d, 3), cells below the horizon\n"
        "filled with the value above.");
}

}  // namespace python
