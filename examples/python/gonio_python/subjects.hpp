#pragma once
/// The module's subjects, one file each. A subject comes after the subjects whose classes it uses.

#include <gonio/basis/pca.hpp>
#include <gonio/core/progress.hpp>

#include <pybind11/pybind11.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace python {

void add_cells(pybind11::module_& m);
void add_tables(pybind11::module_& m);
void add_spectral_table(pybind11::module_& m);
void add_samples(pybind11::module_& m);
void add_estimators(pybind11::module_& m);
void add_reconstruct(pybind11::module_& m);
void add_design(pybind11::module_& m);
void add_models(pybind11::module_& m);
void add_rendering(pybind11::module_& m);
void add_maps(pybind11::module_& m);

/// Returns the given prior file, by default the one that ships with the package.
[[nodiscard]] std::filesystem::path prior_file(const std::optional<std::filesystem::path>& given);

/// Returns a callback for long computations: ends them with KeyboardInterrupt after Ctrl-C.
[[nodiscard]] gonio::progress interruption();

/// Returns HTML for notebooks: a small sphere of a BRDF under two lights, and an object's `repr`.
[[nodiscard]] std::string sphere_as_html(const pybind11::object& brdf, const pybind11::object& described);

/// Issues Python's own `warnings`.
void warn(const std::vector<std::string>& sentences);

}  // namespace python
