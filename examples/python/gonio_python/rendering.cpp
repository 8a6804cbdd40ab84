/// Spheres, image files, and comparison of tables.

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
#include <gonio/model/instrument_readings.hpp>
#include <gonio/render/environment_sampler.hpp>
#include <gonio/render/half_vector_sampler.hpp>
#include <gonio/render/lookup_table.hpp>
#include <gonio/render/sampled_sphere.hpp>

#include <pybind11/stl.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace python {

namespace {

void require_between(const char* name, int value, int lowest, int highest) {
  if (value < lowest || value > highest) gonio::refuse({name, " is ", value, ": expected ", lowest, " to ", highest});
}

/// Returns an image of a sphere in linear light, as `gonio render` draws it before exposure.
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

/// Returns a table unchanged, and tabulates any other BRDF over some cells.
gonio::brdf_table tabulated(const py::object& brdf, const char* name, const gonio::valid_cells& cells) {
  if (py::isinstance<gonio::brdf_table>(brdf)) return brdf.cast<gonio::brdf_table>();
  if (!py::hasattr(brdf, "tabulate"))
    gonio::refuse({name, " is ", std::string(py::repr(brdf)), ": expected a BRDF of gonio, such as a Table"});
  return brdf.attr("tabulate")(py::arg("cells") = cells).cast<gonio::brdf_table>();
}

/// Returns the cells for a comparison: the truth's if it is a table, else the estimate's.
gonio::valid_cells common_cells(const py::object& estimate, const py::object& truth) {
  for (const py::object& each : {truth, estimate})
    if (py::isinstance<gonio::brdf_table>(each)) return each.cast<const gonio::brdf_table&>().cells();
  return gonio::valid_cells();
}

py::object compare_brdfs(const py::object& estimate, const py::object& truth,
                         const std::optional<gonio::log_relative_pca>& prior, unsigned threads) {
  const std::filesystem::path shipped = prior ? std::filesystem::path() : prior_file({});
  const gonio::valid_cells cells = common_cells(estimate, truth);
  const gonio::brdf_table found = tabulated(estimate, "estimate", cells), expected = tabulated(truth, "truth", cells);
  gonio::comparison errors;
  gonio::model::instrument_readings of_estimate, of_truth;
  {
    const py::gil_scoped_release released;
    const gonio::log_relative metric = prior ? prior->metric() : gonio::io::read_prior(shipped).metric();
    const gonio::appearance_metric appearance(cells, 36, gonio::thread_count{threads});
    errors = gonio::compare(found, expected, metric, appearance, gonio::thread_count{threads});
    of_estimate = gonio::model::read_instruments(found);
    of_truth = gonio::model::read_instruments(expected);
  }
  cli::json all = cli::to_json(errors);
  all["readings"] = {{"estimate", cli::to_json(of_estimate)}, {"truth", cli::to_json(of_truth)}};
  return to_python(all);
}

py::object instrument_readings(const py::object& brdf) {
  const gonio::brdf_table table = tabulated(brdf, "brdf", gonio::valid_cells());
  gonio::model::instrument_readings readings;
  {
    const py::gil_scoped_release released;
    readings = gonio::model::read_instruments(table);
  }
  return to_python(cli::to_json(readings));
}

/// Returns an image (PNG) of a sphere with the tool's exposure.
py::bytes sphere_png(const gonio::brdf_table& table, int size) {
  std::vector<gonio::image> sphere{cli::sphere_image(table, {.size = size, .exposure = {}}, {})};
  cli::expose_spheres(sphere, {});
  const std::vector<std::byte> bytes = gonio::io::write_png(sphere.front(), "a sphere");
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

std::string sphere_as_html(const py::object& brdf, const py::object& described) {
  constexpr int size = 96;
  const py::object table = brdf.attr("tabulate")();
  const py::object encoded =
      py::module_::import("base64").attr("b64encode")(sphere_png(table.cast<const gonio::brdf_table&>(), size));
  const py::object sentence = py::module_::import("html").attr("escape")(py::repr(described));
  return gonio::message_of(
      {"<img width=\"", size, "\" height=\"", size, "\" alt=\"a sphere under two lights\" src=\"data:image/png;base64,",
       encoded.attr("decode")().cast<std::string>(), "\"><br><code>", sentence.cast<std::string>(), "</code>"});
}

void add_rendering(py::module_& m) {
  m.def("render_sphere", &sphere_under_lights, py::arg("table"), py::kw_only(), py::arg("size") = 256,
        py::arg("threads") = 0,
        "Returns an image of a sphere of a table, or of any other BRDF, under two lights in linear light: a new\n"
        "float32 array of shape (size, size, 3). A white Lambertian sphere has the mean luminance 1.");
  m.def("render_sphere_in", &sphere_in_environment, py::arg("table"), py::arg("environment"), py::kw_only(),
        py::arg("size") = 256, py::arg("quality") = 64, py::arg("white") = 0.4, py::arg("seed") = 1,
        py::arg("threads") = 0,
        "Returns an image of a sphere in an environment: a latitude-longitude image of shape (n, 2 n, 3), linear\n"
        "radiance. quality: the number of samples per pixel drawn from the BRDF, and as many from the environment.\n"
        "white: the mean luminance of a white Lambertian sphere. Ctrl-C ends the rendering.");
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
  m.def("compare", &compare_brdfs, py::arg("estimate"), py::arg("truth"), py::arg("prior") = py::none(),
        py::arg("threads") = 0,
        "Returns the errors of an estimate against the truth, both BRDFs of any kind, as `gonio compare --json`\n"
        "prints them. They are compared over the cells of the truth if it is a Table, else of the estimate, else of a\n"
        "MERL file. prior: its metric maps reflectance; by default that of the prior that ships with the package.");
  m.def("instrument_readings", &instrument_readings, py::arg("brdf"),
        "Returns what instruments would read on a BRDF, as a dictionary: gloss at 20, 60 and 85 degrees (ISO 2813) and "
        "haze at\n"
        "20 (ISO 13803) in gloss units, the haze index (ASTM D4039), the reflectance of light at 8 degrees with and\n"
        "without the specular part, the total integrated scatter, and L*, a*, b* (D65) at aspecular angles.");
}

}  // namespace python
