#pragma once
/// The common methods of Python's BRDFs.

#include "arrays.hpp"
#include "subjects.hpp"
#include <gonio/core/brdf.hpp>
#include <gonio/io/materials/merl.hpp>
#include <gonio/model/adaptive_brdf.hpp>
#include <gonio/table/brdf_table.hpp>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <concepts>
#include <filesystem>
#include <optional>
#include <string>

namespace python {

/// Returns a table over some cells, by default a MERL file's: by the BRDF's own `tabulate` if it has one, else value by
/// value.
template <gonio::brdf Brdf>
[[nodiscard]] gonio::brdf_table table_of(const Brdf& f, gonio::thread_count threads,
                                         const gonio::valid_cells& cells = gonio::valid_cells()) {
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

/// Any BRDF behind a function pointer, for code that is compiled once for all BRDFs.
struct brdf_by_pointer {
  const void* f;
  gonio::rgb (*value)(const void*, const gonio::direction&, const gonio::direction&) noexcept;

  [[nodiscard]] gonio::rgb operator()(const gonio::direction& wi, const gonio::direction& wo) const noexcept {
    return value(f, wi, wo);
  }
};

template <gonio::brdf Brdf>
[[nodiscard]] brdf_by_pointer pointer_to(const Brdf& f) noexcept {
  return {&f, [](const void* held, const gonio::direction& wi, const gonio::direction& wo) noexcept -> gonio::rgb {
            return (*static_cast<const Brdf*>(held))(wi, wo);
          }};
}

/// Writes a material of the RGL database, with its own tables if it has some.
void write_rgl(const std::filesystem::path& path, const gonio::model::adaptive_brdf& f);
void write_rgl(const std::filesystem::path& path, const brdf_by_pointer& f);

/// Adds the functions that write files for renderers to the module.
template <gonio::brdf Brdf>
void add_brdf_files(py::module_& m) {
  m.def(
      "write_merl",
      [](const std::filesystem::path& path, const Brdf& f) {
        if constexpr (std::same_as<Brdf, gonio::brdf_table>)
          gonio::io::write_merl(path, f);
        else
          gonio::io::write_merl(path, table_of(f, {}));
      },
      py::arg("path"), py::arg("brdf"), py::call_guard<py::gil_scoped_release>(),
      "Writes a MERL file, which renderers read. An existing file is replaced only when the new one is complete.");
  m.def(
      "write_rgl",
      [](const std::filesystem::path& path, const Brdf& f) {
        if constexpr (std::same_as<Brdf, gonio::model::adaptive_brdf>)
          write_rgl(path, f);
        else
          write_rgl(path, pointer_to(f));
      },
      py::arg("path"), py::arg("brdf"), py::call_guard<py::gil_scoped_release>(),
      "Writes a file of the RGL database (.bsdf) in RGB, which Mitsuba's `measured` reads: values over a\n"
      "parameterisation that follows the highlight. Negative values become 0. An existing file is replaced only\n"
      "when the new one is complete.");
}

/// Makes every function that takes a table accept a BRDF of this class, tabulated over the cells of a MERL file.
template <gonio::brdf Brdf>
void add_conversion_to_table() {
  auto table = py::reinterpret_borrow<py::class_<gonio::brdf_table>>(py::type::of<gonio::brdf_table>());
  table.def(py::init([](const Brdf& f) {
              if constexpr (std::same_as<Brdf, gonio::brdf_table>)
                return f;
              else
                return table_of(f, {});
            }),
            py::prepend(), py::arg("brdf"),
            "Tabulates a BRDF over the 90 x 90 x 180 cells of MERL's grid. If `brdf` is already a table, copies it.");
  if constexpr (!std::same_as<Brdf, gonio::brdf_table>) py::implicitly_convertible<Brdf, gonio::brdf_table>();
}

/// Returns values in sr^-1 for many pairs.
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

/// Adds the methods of every BRDF to a class, and functions for files of its objects to the module.
template <gonio::brdf Brdf, class... Extra>
void add_brdf_methods(py::module_& m, py::class_<Brdf, Extra...>& type) {
  type.def("__call__", &evaluate<Brdf>, py::arg("wi"), py::arg("wo"), py::arg("threads") = 0,
           "Returns the reflectance in sr^-1, without the cosine, for directions to the light and to the viewer:\n"
           "arrays of shape (..., 3) of unit vectors, normal +z. The result has the same shape; it is zero below\n"
           "the horizon.");
  type.def(
      "tabulate",
      [](const Brdf& f, unsigned threads, const std::optional<gonio::valid_cells>& cells) {
        return table_of(f, gonio::thread_count{threads}, cells ? *cells : gonio::valid_cells());
      },
      py::arg("threads") = 0, py::kw_only(), py::arg("cells") = py::none(), py::call_guard<py::gil_scoped_release>(),
      "Returns a table over some cells, such as another table's `cells`; by default over the 90 x 90 x 180 cells of\n"
      "a MERL file.");
  type.def(
      "_repr_html_", [](const py::object& self) { return sphere_as_html(self, self); },
      "Returns HTML for notebooks: a small sphere and the repr.");
  add_brdf_files<Brdf>(m);
  add_conversion_to_table<Brdf>();
}

}  // namespace python
