/// Tables of spectra.

#include "spectra.hpp"

#include "subjects.hpp"
#include <gonio/core/error.hpp>
#include <gonio/io/materials/rgl_spectra.hpp>

#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <utility>
#include <vector>

namespace python {

gonio::illuminant illuminant_of(const std::string& name) {
  if (name == "D65") return gonio::illuminant::d65;
  if (name == "A") return gonio::illuminant::a;
  gonio::refuse({"illuminant is '", name, "': expected 'D65' or 'A'"});
}

namespace {

py::array_t<float> values_of(const py::object& self) {
  auto& table = self.cast<gonio::spectral_table&>();
  constexpr py::ssize_t step = sizeof(float);
  return view_of(table.values().data(), {table.cells().size(), table.bands()}, {table.bands() * step, step}, self);
}

gonio::spectral_table table_of_state(const py::tuple& state) {
  require_state(state, 3);
  gonio::valid_cells cells = cells_of_state(state[0].cast<py::tuple>());
  std::vector<double> wavelengths(py::len(state[1]));
  copy_numbers(state[1], wavelengths.data(), std::ssize(wavelengths));
  return {std::move(cells), std::move(wavelengths), matrix_of<gonio::cell_matrix>(state[2])};
}

}  // namespace

void add_spectral_table(py::module_& m) {
  py::class_<gonio::spectral_table> table(
      m, "SpectralTable", "The spectra of a material over the cells of a grid, sr^-1. `colours` makes a Table of it.");
  table.def(py::init<gonio::valid_cells, std::vector<double>>(), py::arg("cells"), py::arg("wavelengths"),
            "Makes a table of zeros. wavelengths: in nanometres, ascending.");
  table.def("__len__", [](const gonio::spectral_table& t) { return t.cells().size(); });
  table.def("__repr__", [](const gonio::spectral_table& t) {
    return gonio::message_of({"<gonio.SpectralTable: ", t.bands(), " wavelengths, ", sentence_of(t.cells()), ">"});
  });
  table.def_property_readonly("cells", &gonio::spectral_table::cells, "The cells of the values.");
  table.def_property_readonly(
      "wavelengths", [](const gonio::spectral_table& t) { return array_of_numbers(t.wavelengths()); },
      "The wavelengths in nanometres, ascending.");
  table.def_property_readonly("values", &values_of,
                              "The table's own memory as an array of float32, shape (cells, wavelengths): writing to\n"
                              "it changes the table.");
  table.def(
      "__call__",
      [](const gonio::spectral_table& t, const py::object& wi, const py::object& wo, unsigned threads) {
        return evaluate_channels(t, t.bands(), wi, wo, threads);
      },
      py::arg("wi"), py::arg("wo"), py::arg("threads") = 0,
      "Returns the reflectance in sr^-1, without the cosine: shape (..., wavelengths). It is zero below the horizon.");
  table.def(
      "colours",
      [](const gonio::spectral_table& t, const std::string& light) { return t.colours(illuminant_of(light)); },
      py::arg("illuminant") = "D65", py::call_guard<py::gil_scoped_release>(),
      "Returns the table in linear Rec. 709 under an illuminant, 'D65' or 'A'.");
  add_copies(
      table,
      [](const gonio::spectral_table& t) {
        return py::make_tuple(state_of(t.cells()), array_of_numbers(t.wavelengths()), copy_of(t.values()));
      },
      &table_of_state);
  m.def(
      "write_rgl",
      [](const std::filesystem::path& path, const gonio::spectral_table& t) {
        gonio::io::write_rgl(
            path, gonio::io::tabulate_adaptively(t, gonio::model::usual_albedo_tolerance, path.stem().string()));
      },
      py::arg("path"), py::arg("brdf"), py::call_guard<py::gil_scoped_release>(),
      "Writes a spectral file of the RGL database (.bsdf), which pbrt-v4 and spectral variants of Mitsuba read. It\n"
      "keeps the wavelengths between which linear interpolation is within 0.6 %.");
}

}  // namespace python
