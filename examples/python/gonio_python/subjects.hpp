#pragma once
/// The subjects of the module, one file each. The order is that of who needs whose classes.

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
void add_samples(pybind11::module_& m);
void add_estimators(pybind11::module_& m);
void add_reconstruct(pybind11::module_& m);
void add_design(pybind11::module_& m);
void add_models(pybind11::module_& m);
void add_rendering(pybind11::module_& m);
void add_maps(pybind11::module_& m);

/// The prior that ships with the package, unless another is given.
[[nodiscard]] std::filesystem::path prior_file(const std::optional<std::filesystem::path>& given);

/// What long work calls now and then: it ends with KeyboardInterrupt after Ctrl-C.
[[nodiscard]] gonio::progress interruption();

/// What notebooks show: a small sphere of a BRDF under two lights, and what `repr` says of an object.
[[nodiscard]] std::string sphere_as_html(const pybind11::object& brdf, const pybind11::object& described);

/// Through Python's own `warnings`.
void warn(const std::vector<std::string>& sentences);

}  // namespace python
