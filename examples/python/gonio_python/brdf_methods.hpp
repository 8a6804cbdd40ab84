#pragma once
/// What Python's BRDFs have in common, whatever they are.

#include "arrays.hpp"
#include <gonio/core/brdf.hpp>
#include <gonio/io/materials/merl.hpp>
#include <gonio/table/brdf_table.hpp>

#include <pybind11/stl/filesystem.h>

#include <concepts>

namespace python {

/// A table over the cells of a MERL file: of a fit by the way that it knows, of anything else value by value.
template <gonio::brdf Brdf>
[[nodiscard]] gonio::brdf_table table_of(const Brdf& f, gonio::thread_count threads) {
  const gonio::valid_cells cells;
  if constexpr (requires {
                  { f.tabulate(cells, threads) } -> std::same_as<gonio::brdf_table>;
                })
    return f.tabulate(cells, threads);
  else if constexpr (requires {
                       { f.tabulate(cells) } -> std::same_as<gonio::brdf_table>;
                     })
    return f.tabulate(cells);
  else
    return gonio::tabulate(f, cells, threads);
}

/// Values in sr^-1 of many pairs.
template <gonio::brdf Brdf>
[[nodiscard]] py::array_t<double> evaluate(const Brdf& f, const py::object& wi, const py::object& wo,
                                           unsigned threads) {
  const direction_pairs pairs(wi, wo);
  py::array_t<double> values = results_for(pairs, 3);
  double* to = values.mutable_data();
  const py::gil_scoped_release released;
  gonio::for_each_index(
      pairs.size(), 1024,
      [&](Eigen::Index i) {
        const gonio::rgb value = f(pairs.wi(i), pairs.wo(i));
        std::copy_n(value.data(), 3, to + 3 * i);
      },
      gonio::thread_count{threads});
  return values;
}

/// Adds the call `f(wi, wo)` and `tabulate()` to a class, and to the module `write_merl` of its objects.
template <gonio::brdf Brdf, class... Extra>
void add_brdf_methods(py::module_& m, py::class_<Brdf, Extra...>& type) {
  type.def("__call__", &evaluate<Brdf>, py::arg("wi"), py::arg("wo"), py::arg("threads") = 0,
           "Reflectance in sr^-1, without the cosine, for the directions to the light and to the viewer: arrays of\n"
           "shape (..., 3) of unit vectors, normal +z. The result has the same shape; it is zero below the horizon.");
  type.def(
      "tabulate", [](const Brdf& f, unsigned threads) { return table_of(f, gonio::thread_count{threads}); },
      py::arg("threads") = 0, py::call_guard<py::gil_scoped_release>(),
      "A table over the 90 x 90 x 180 cells of a MERL file.");
  m.def(
      "write_merl",
      [](const std::filesystem::path& path, const Brdf& f) {
        if constexpr (std::same_as<Brdf, gonio::brdf_table>)
          gonio::io::write_merl(path, f);
        else
          gonio::io::write_merl(path, table_of(f, {}));
      },
      py::arg("path"), py::arg("brdf"), py::call_guard<py::gil_scoped_release>(),
      "Writes a MERL file, which renderers read. An existing file is replaced once the new one is complete.");
}

}  // namespace python
