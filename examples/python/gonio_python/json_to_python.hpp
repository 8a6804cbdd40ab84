#pragma once
/// Converts the tool's JSON to Python's dictionaries and lists.

#include "tool/files/json.hpp"

#include <pybind11/pybind11.h>

namespace python {

[[nodiscard]] inline pybind11::object to_python(const cli::json& value) {
  return pybind11::module_::import("json").attr("loads")(value.dump());
}

}  // namespace python
