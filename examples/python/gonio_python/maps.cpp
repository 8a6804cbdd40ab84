/// Maps of spatially varying BRDFs, written by `gonio svbrdf`.

#include "arrays.hpp"
#include "copies.hpp"
#include "subjects.hpp"
#include <gonio/core/error.hpp>
#include <gonio/core/half.hpp>
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/materials/svbrdf_map.hpp>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace python {

namespace {

/// A complete map in memory.
struct texel_map {
  gonio::io::svbrdf_header header;
  gonio::log_relative_pca prior;
  py::array weights, uncertainty, disagreement;  ///< half floats: (rows, columns, 3, r) and twice (rows, columns)
};

/// Returns an uninitialised array of half floats.
py::array halves(extents shape) { return py::array(py::dtype("float16"), std::move(shape)); }

/// Copies numbers into an array of half floats from index `first` on.
void put(py::array& to, Eigen::Index first, std::span<const std::uint16_t> numbers) {
  std::memcpy(static_cast<std::uint16_t*>(to.mutable_data()) + first, numbers.data(), numbers.size_bytes());
}

texel_map read_map(const std::filesystem::path& path, const std::optional<gonio::log_relative_pca>& prior) {
  const gonio::io::svbrdf_map map(path);
  const gonio::io::svbrdf_header& header = map.header();
  texel_map read{header, prior ? *prior : gonio::io::read_prior(prior_file({})),
                 halves({header.rows, header.columns, 3, header.functions.cols()}),
                 halves({header.rows, header.columns}), halves({header.rows, header.columns})};
  map.require_prior(read.prior);
  for (Eigen::Index band = 0; band < header.bands(); ++band) {
    const gonio::io::svbrdf_band numbers = map.read_band(band);
    const Eigen::Index first = band * header.band_rows * header.columns;
    put(read.weights, 3 * header.functions.cols() * first, numbers.weights);
    put(read.uncertainty, first, numbers.uncertainty);
    put(read.disagreement, first, numbers.disagreement);
  }
  return read;
}

gonio::fitted_brdf<gonio::log_relative_pca> brdf_of(const texel_map& map, py::ssize_t row, py::ssize_t column) {
  const auto [rows, columns] = std::array{map.header.rows, map.header.columns};
  if (row < 0 || row >= rows || column < 0 || column >= columns)
    throw py::index_error(gonio::message_of({"the map has ", rows, " x ", columns, " texels"}));
  const Eigen::Index functions = map.header.functions.cols(), texel = row * columns + column;
  const auto* bits = static_cast<const std::uint16_t*>(map.weights.data()) + 3 * functions * texel;
  if (static_cast<const std::uint16_t*>(map.uncertainty.data())[texel] == 0)
    gonio::refuse({"the texel of row ", row, ", column ", column, " is outside the sample"});
  Eigen::MatrixXd weights(functions, 3);
  for (Eigen::Index i = 0; i < weights.size(); ++i) weights.data()[i] = double{gonio::from_half(bits[i])};
  return {map.prior, map.header.functions.cast<double>() * weights};
}

}  // namespace

void add_maps(py::module_& m) {
  py::class_<texel_map> map(m, "Map", "A spatially varying BRDF: for each texel the weights of a prior's functions.");
  map.def_property_readonly(
      "shape", [](const texel_map& self) { return py::make_tuple(self.header.rows, self.header.columns); },
      "Rows and columns of texels.");
  map.def_property_readonly(
      "prior", [](const texel_map& self) { return self.prior; }, "The prior whose components the functions combine.");
  map.def_property_readonly(
      "functions", [](const texel_map& self) { return copy_of(self.header.functions); },
      "Matrix of shape (k, r): `functions @ weights[row, column].T` are the weights of the prior's k components.");
  map.def_property_readonly(
      "directions", [](const texel_map& self) { return array_of(self.header.directions); },
      "The directions in which the texels were measured, wi and wo: shape (images, 6).");
  map.def_readonly("weights", &texel_map::weights,
                   "float16 of shape (rows, columns, 3, r): the weights for red, green and blue.");
  map.def_readonly(
      "uncertainty", &texel_map::uncertainty,
      "float16 of shape (rows, columns): root mean square, over all directions, of the standard deviation\n"
      "of the reflectance's natural logarithm; 0 for texels outside the sample.");
  map.def_readonly(
      "disagreement", &texel_map::disagreement,
      "float16 of shape (rows, columns): difference of an image from its prediction by all other images, in\n"
      "expected deviations, root mean square over the images.");
  map.def("brdf", &brdf_of, py::arg("row"), py::arg("column"),
          "Returns the BRDF of a texel. Raises IndexError outside the map, and Error for a texel outside the\n"
          "sample.");
  map.def("__repr__", [](const texel_map& self) {
    return gonio::message_of({"<gonio.Map: ", self.header.rows, " x ", self.header.columns, " texels of ",
                              self.header.functions.cols(), " functions>"});
  });
  m.def("read_map", &read_map, py::arg("path"), py::arg("prior") = py::none(),
        "Reads a complete map of `gonio svbrdf` (.gsv). prior: the prior that it was made with, by default the one\n"
        "that ships with the package. Raises Error for another prior, and for a damaged file.");
}

}  // namespace python
