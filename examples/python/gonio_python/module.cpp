/// The Python module: its exception and its subjects.

#include "subjects.hpp"
#include "words.hpp"
#include <gonio/core/error.hpp>

#include <pybind11/pybind11.h>

#include <exception>

namespace python {

namespace py = pybind11;

std::filesystem::path prior_file(const std::optional<std::filesystem::path>& given) {
  if (given) return *given;
  const auto module = py::module_::import("gonio._gonio").attr("__file__").cast<std::string>();
  return std::filesystem::path(module).parent_path() / "materials.prior";
}

gonio::progress interruption() {
  return [](std::string_view, double) {
    const py::gil_scoped_acquire held;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  };
}

/// Adds the exception for refusals of library and tool, whose messages are in Python's terms.
void add_error(py::module_& m) {
  static const py::handle type = py::exception<gonio::error>(m, "Error", PyExc_ValueError).release();
  type.attr("__module__") = "gonio";
  type.attr("__doc__") = "Bad input. The message is one sentence: the fault, its location, and the expected input.";
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const gonio::error& refusal) {
      PyErr_SetString(type.ptr(), in_python(refusal.what()).c_str());
    }
  });
}

void warn(const std::vector<std::string>& sentences) {
  for (const std::string& sentence : sentences)
    if (PyErr_WarnEx(PyExc_UserWarning, sentence.c_str(), 1) != 0) throw py::error_already_set();
}

}  // namespace python

PYBIND11_MODULE(_gonio, m) {
  m.doc() = "Complete BRDFs from a few reflectance measurements.";
  m.attr("__version__") = GONIO_VERSION;
  python::add_error(m);
  python::add_cells(m);
  python::add_tables(m);
  python::add_spectral_table(m);
  python::add_samples(m);
  python::add_estimators(m);
  python::add_reconstruct(m);
  python::add_design(m);
  python::add_models(m);
  python::add_rendering(m);
  python::add_maps(m);
}
