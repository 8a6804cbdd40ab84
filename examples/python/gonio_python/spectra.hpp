#pragma once
/// Spectra in Python: illuminants by name, and the values of fits at wavelengths.

#include "arrays.hpp"
#include "cells.hpp"
#include "copies.hpp"
#include <gonio/core/parallel.hpp>
#include <gonio/core/spectrum.hpp>
#include <gonio/table/spectral_table.hpp>

#include <pybind11/stl.h>

#include <algorithm>
#include <optional>
#include <string>

namespace python {

/// Returns the illuminant D65 or A. Throws gonio::error for any other name.
[[nodiscard]] gonio::illuminant illuminant_of(const std::string& name);

/// Returns for each of many pairs the c values that `values(wi, wo)` returns: shape (..., c).
template <class Values>
[[nodiscard]] py::array_t<double> evaluate_channels(const Values& values, Eigen::Index c, const py::object& wi,
                                                    const py::object& wo, unsigned threads) {
  const direction_pairs pairs(wi, wo);
  extents shape = pairs.shape();
  shape.push_back(c);
  py::array_t<double> found(shape);
  double* to = found.mutable_data();
  const py::gil_scoped_release released;
  gonio::for_each_index(
      pairs.size(), 64,
      [&](Eigen::Index i) {
        const auto one = values(pairs.wi(i), pairs.wo(i));
        std::copy_n(one.data(), c, to + c * i);
      },
      gonio::thread_count{threads});
  return found;
}

/// Adds the spectral properties of a fit. `fit_of` returns the fit in its own channels.
template <class Fit, class... Extra, class FitOf>
void add_spectra(py::class_<Fit, Extra...>& type, const FitOf& fit_of) {
  type.def_property_readonly(
      "wavelengths",
      [=](const Fit& f) -> py::object {
        if (!fit_of(f).channels().are_wavelengths()) return py::none();
        return array_of_numbers(fit_of(f).channels().wavelengths());
      },
      "The wavelengths of the fitted samples in nanometres; None for colours.");
  type.def(
      "values",
      [=](const Fit& f, const py::object& wi, const py::object& wo, unsigned threads) {
        return evaluate_channels([&](const auto& i, const auto& o) { return f.values(i, o); },
                                 fit_of(f).channels().size(), wi, wo, threads);
      },
      py::arg("wi"), py::arg("wo"), py::arg("threads") = 0,
      "Returns the reflectance in sr^-1 in the channels of the samples: shape (..., wavelengths), or (..., 3).");
  type.def(
      "tabulate_spectra",
      [=](const Fit& f, const std::optional<gonio::valid_cells>& cells) {
        if (!fit_of(f).channels().are_wavelengths()) gonio::refuse("the samples of this fit have no wavelengths");
        return f.tabulate_spectra(cells ? *cells : gonio::valid_cells());
      },
      py::kw_only(), py::arg("cells") = py::none(), py::call_guard<py::gil_scoped_release>(),
      "Returns the spectra of all directions over some cells, by default those of a MERL file: 4 MB per wavelength.");
}

}  // namespace python
