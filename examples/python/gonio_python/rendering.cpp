/// Spheres, images as files, and how tables differ.

#include "brdf_methods.hpp"
#include "json_to_python.hpp"
#include "subjects.hpp"
#include "tool/pages/images.hpp"
#include "tool/pages/measures_as_json.hpp"
#include <gonio/evaluate/appearance_metric.hpp>
#include <gonio/evaluate/comparison.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/model/adaptive_brdf.hpp>
#include <gonio/model/analytic_brdf.hpp>
#include <gonio/model/formula_materials.hpp>
#include <gonio/render/environment_sampler.hpp>
#include <gonio/render/half_vector_sampler.hpp>
#include <gonio/render/lookup_table.hpp>
#include <gonio/render/sampled_sphere.hpp>

#include <pybind11/stl.h>

#include <algorithm>
#include <optional>

namespace python {

namespace {

void require_between(const char* name, int value, int lowest, int highest) {
  if (value < lowest || value > highest) gonio::refuse({name, " is ", value, ": expected ", lowest, " to ", highest});
}

/// In linear light, as `gonio render` draws it before it is exposed.
py::array_t<float> sphere_under_lights(const gonio::brdf_table& table, int size, unsigned threads) {
  require_between("size", size, 8, 4096);
  std::optional<gonio::image> drawn;
  {
    const py::gil_scoped_release released;
    drawn.emplace(cli::sphere_image(table, {.size = size, .exposure = {}}, gonio::thread_count{threads}));
  }
  return array_of(std::move(*drawn));
}

py::array_t<float> sphere_in_environment(const gonio::brdf_table& table, const py::object& environment, int size,
                                         int quality, double white, std::uint64_t seed, unsigned threads) {
  require_between("size", size, 8, 4096);
  require_between("quality", quality, 1, 1'000'000);
  if (!(white > 0.0 && white <= 1e6)) gonio::refuse({"white is ", white, ": expected a positive number"});
  gonio::image radiance = image_of(environment, "environment");
  std::optional<gonio::image> drawn;
  {
    const py::gil_scoped_release released;
    const gonio::render::environment_sampler light(gonio::render::environment_map(std::move(radiance)));
    const gonio::render::half_vector_sampler material(gonio::render::lookup_table<>::of(table));
    drawn.emplace(gonio::render::render_sphere(material, light,
                                               {.size = size, .samples = quality, .seed = seed, .white = white},
                                               gonio::thread_count{threads}, interruption()));
  }
  return array_of(std::move(*drawn));
}

py::object compare_tables(const gonio::brdf_table& estimate, const gonio::brdf_table& truth,
                          const std::optional<gonio::log_relative_pca>& prior, unsigned threads) {
  const std::filesystem::path shipped = prior ? std::filesystem::path() : prior_file({});
  gonio::comparison errors;
  {
    const py::gil_scoped_release released;
    const gonio::log_relative metric = prior ? prior->metric() : gonio::io::read_prior(shipped).metric();
    const gonio::appearance_metric appearance(truth.cells(), 36, gonio::thread_count{threads});
    errors = gonio::compare(estimate, truth, metric, appearance, gonio::thread_count{threads});
  }
  return to_python(cli::to_json(errors));
}

}  // namespace

void add_rendering(py::module_& m) {
  m.def(
      "render_sphere", &sphere_under_lights, py::arg("table"), py::kw_only(), py::arg("size") = 256,
      py::arg("threads") = 0,
      "A sphere under two lights in linear light: float32 of shape (size, size, 3), which nobody else holds. A white\n"
      "Lambertian sphere has the mean luminance 1.");
  m.def(
      "render_sphere_in", &sphere_in_environment, py::arg("table"), py::arg("environment"), py::kw_only(),
      py::arg("size") = 256, py::arg("quality") = 64, py::arg("white") = 0.4, py::arg("seed") = 1,
      py::arg("threads") = 0,
      "A sphere in light from all around: a latitude-longitude image of shape (n, 2 n, 3), linear radiance. quality:\n"
      "samples of the BRDF, and as many of the environment, for each pixel. white: the mean luminance that a white\n"
      "Lambertian sphere would have. Ctrl-C ends it.");
  m.def(
      "write_png",
      [](const std::filesystem::path& path, const py::object& image) {
        gonio::io::write_png(path, image_of(image, "image"));
      },
      py::arg("path"), py::arg("image"),
      "Writes linear light of shape (rows, columns, 3) as a PNG: clipped to [0, 1], sRGB-encoded.");
  m.def(
      "read_hdr", [](const std::filesystem::path& path) { return array_of(gonio::io::read_hdr(path)); },
      py::arg("path"), "Reads a Radiance HDR image: float32 of shape (rows, columns, 3).");
  m.def("compare", &compare_tables, py::arg("estimate"), py::arg("truth"), py::arg("prior") = py::none(),
        py::arg("threads") = 0,
        "How an estimated table differs from the truth: what `gonio compare --json` prints. prior: whose metric maps\n"
        "reflectance; without one that of the prior that ships with the package.");
}

}  // namespace python
