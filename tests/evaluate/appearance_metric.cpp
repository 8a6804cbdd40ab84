#include <gonio/evaluate/appearance_metric.hpp>
#include <gonio/model/formula_materials.hpp>

#include <doctest/doctest.h>

#include <map>

using gonio::appearance_metric;
using gonio::brdf_table;
using gonio::rgb;
using gonio::tabulate;
using gonio::valid_cells;
using gonio::model::ggx;
using gonio::model::lambertian;
using gonio::model::sum_of_lobes;

namespace {

/// A small grid, on which appearance metrics are made quickly.
const valid_cells& sphere_cells() {
  static const valid_cells cells(gonio::grid({20, 15, 30}));
  return cells;
}

const appearance_metric& small_metric() {
  static const appearance_metric appearance(sphere_cells(), 12);
  return appearance;
}

brdf_table grey(double albedo) { return tabulate(lambertian{rgb::Constant(albedo)}, sphere_cells()); }

}  // namespace

TEST_CASE("colour differences agree with the reference on MERL's grid") {
  // Expected values: build_lights, build_env and deltaE of the reference's render.py (numpy 1.24, float64) on these
  // tables, which this library wrote as raw float32. Every pixel of every table agreed to 6e-8 relative, so the printed
  // digits must agree.
  const valid_cells cells;
  const appearance_metric appearance(cells);
  CHECK(appearance.lights().points().size() == 1020);

  std::map<std::string, gonio::appearance> seen;
  for (const std::string& name : gonio::model::formula_material_names())
    seen[name] = appearance.look(tabulate(gonio::model::formula_material(name), cells));
  const lambertian red{{0.42, 0.028, 0.022}};
  seen["rougher"] = appearance.look(tabulate(sum_of_lobes{red, ggx{.alpha = 0.2, .f0 = rgb::Constant(0.04)}}, cells));
  seen["mirror"] = appearance.look(tabulate(ggx{.alpha = 0.02, .f0 = {0.9, 0.6, 0.3}}, cells));

  struct expectation {
    const char *a, *b;
    double lights, environment;
  };
  for (const auto& [a, b, lights, environment] : {
           expectation{"red-paint", "blue-rubber", 64.168125, 67.979173},
           expectation{"red-paint", "gold-metal", 43.786786, 54.758990},
           expectation{"red-paint", "grey-lambertian", 48.504586, 48.802228},
           expectation{"red-paint", "rougher", 1.331238, 1.166785},
           expectation{"red-paint", "mirror", 55.085750, 43.916267},
           expectation{"blue-rubber", "gold-metal", 54.967971, 77.992180},
           expectation{"blue-rubber", "grey-lambertian", 36.144529, 38.786328},
           expectation{"gold-metal", "grey-lambertian", 24.244316, 42.869887},
           expectation{"gold-metal", "mirror", 47.834395, 24.146287},
           expectation{"grey-lambertian", "mirror", 38.248325, 22.642290},
           expectation{"rougher", "mirror", 54.970881, 44.222089},
       }) {
    CAPTURE(a);
    CAPTURE(b);
    const auto difference = appearance_metric::difference(seen[a], seen[b]);
    CHECK(std::abs(difference.lights - lights) < 1e-5);
    CHECK(std::abs(difference.environment - environment) < 1e-5);
  }
}

TEST_CASE("a table does not differ from itself, and differences are symmetric") {
  const brdf_table paint = tabulate(gonio::model::formula_material("red-paint"), sphere_cells());
  CHECK(small_metric().difference(paint, paint).lights == 0.0);
  CHECK(small_metric().difference(paint, paint).environment == 0.0);
  const auto there = small_metric().difference(paint, grey(0.2)), back = small_metric().difference(grey(0.2), paint);
  CHECK(there.lights == back.lights);
  CHECK(there.environment == back.environment);
  CHECK(there.lights > 10.0);
  CHECK(there.environment > 10.0);
}

TEST_CASE("the difference is the mean over the pixels of the images' differences") {
  const brdf_table a = grey(0.1), b = tabulate(gonio::model::formula_material("gold-metal"), sphere_cells());
  const auto& op = small_metric().environment();
  const gonio::render::sphere_colours p = op.apply(a), q = op.apply(b);
  double sum = 0.0;
  for (Eigen::Index i = 0; i < p.rows(); ++i) sum += gonio::delta_e(p.row(i).transpose(), q.row(i).transpose());
  CHECK(small_metric().difference(a, b).environment ==
        doctest::Approx(sum / static_cast<double>(p.rows())).epsilon(1e-13));
}

TEST_CASE("black and an overexposed sphere are 100 apart in lightness where light falls; beyond white is white") {
  // The environment lights every pixel of the sphere.
  CHECK(small_metric().difference(grey(0.0), grey(500.0)).environment == doctest::Approx(100.0).epsilon(1e-4));
  CHECK(small_metric().difference(grey(500.0), grey(1000.0)).environment == 0.0);
}

TEST_CASE("negative reflectance counts as zero, cell by cell") {
  const brdf_table positive = grey(0.3);
  brdf_table negative = positive, clamped = positive;
  for (Eigen::Index cell = 0; cell < sphere_cells().size(); cell += 3) {
    negative.set(cell, rgb(-5.0, 0.1, -1e-3));
    clamped.set(cell, rgb(0.0, 0.1, 0.0));
  }
  const auto difference = small_metric().difference(negative, clamped);
  CHECK(difference.lights == 0.0);
  CHECK(difference.environment == 0.0);
  CHECK(small_metric().difference(negative, positive).environment > 1.0);
}

TEST_CASE("the number of threads does not change a byte of a difference, and other cells are refused") {
  const brdf_table a = grey(0.1), b = tabulate(gonio::model::formula_material("blue-rubber"), sphere_cells());
  const appearance_metric one(sphere_cells(), 12, {1});
  CHECK(one.difference(a, b, {1}).environment == small_metric().difference(a, b, {4}).environment);
  const brdf_table other(valid_cells(gonio::grid({20, 15, 31})));
  CHECK_THROWS_AS((void)small_metric().difference(a, other), gonio::error);
}
