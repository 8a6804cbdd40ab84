#include <gonio/model/formula_materials.hpp>
#include <gonio/render/horizon_lookup.hpp>
#include <gonio/render/sphere.hpp>

#include <doctest/doctest.h>

#include <random>

using gonio::brdf_table;
using gonio::direction;
using gonio::rgb;
using gonio::render::horizon_lookup;

namespace {

double product_of_cosines(const gonio::valid_cells& cells, std::size_t cell) {
  const auto cosine = gonio::cosines(cells.angles(cell));
  return cosine.i * cosine.o;
}

/// Returns a grey table that is `factor` times as bright in cells whose centre is nearly on the horizon, as in
/// estimates.
brdf_table bright_at_the_horizon(double factor) {
  const gonio::valid_cells cells;
  brdf_table table(cells);
  for (Eigen::Index cell = 0; cell < cells.size(); ++cell)
    table.set(cell, rgb::Constant(product_of_cosines(cells, cell) < 0.001 ? 0.1 * factor : 0.1));
  return table;
}

}  // namespace

TEST_CASE("cells that are nearly on the horizon draw no line along the terminator") {
  const brdf_table clean = bright_at_the_horizon(1.0), wild = bright_at_the_horizon(10.0);
  const auto largest_difference = [&](const auto& a, const auto& b) {
    const gonio::render::sphere_view view{.size = 128, .supersampling = 3};
    const gonio::image x = gonio::render::render_sphere(a, gonio::render::two_lights(), view);
    const gonio::image y = gonio::render::render_sphere(b, gonio::render::two_lights(), view);
    double largest = 0.0;
    for (const auto& point : gonio::render::sphere_points(view.size)) {
      // Skips points lit from behind, at the rim: all directions are near the horizon there.
      if (point.normal.dot(direction(-1.0, -1.0, -3.0)) > 0.0) continue;
      const rgb off = gonio::pixel(x, point.row, point.column) - gonio::pixel(y, point.row, point.column);
      largest = std::max(largest, off.maxCoeff());
    }
    return largest;
  };
  const double interpolated = largest_difference(wild, clean);
  const double mended = largest_difference(horizon_lookup(wild), horizon_lookup(clean));
  MESSAGE("brighter by at most " << interpolated << " interpolated, " << mended << " with horizon_lookup");
  CHECK(interpolated > 0.02);
  CHECK(mended < 0.5 * interpolated);
}

TEST_CASE("a table is read within the range of its cells, constants exactly, zero below the horizon") {
  const brdf_table constant = gonio::tabulate(gonio::model::lambertian{{0.3, 0.2, 0.1}}, gonio::valid_cells());
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const auto draw = [&] {
    direction w(normal(random), normal(random), std::abs(normal(random)));
    return direction(w.normalized());
  };
  for (int i = 0; i < 1000; ++i) {
    const direction wi = draw(), wo = draw();
    const rgb read = horizon_lookup(constant)(wi, wo);
    CHECK(((read - rgb(0.3, 0.2, 0.1) / std::numbers::pi).abs() < 1e-7).all());
  }
  CHECK((horizon_lookup(constant)({0.0, 0.6, -0.8}, {0.0, 0.0, 1.0}) == 0.0).all());
}

TEST_CASE("far from the horizon a table is read as by interpolation, but for hundredths") {
  const brdf_table paint = gonio::tabulate(gonio::model::formula_material("red-paint"), gonio::valid_cells());
  std::mt19937 random(6);
  std::uniform_real_distribution<double> polar(0.0, 1.2), azimuth(0.0, 6.28);
  double sum = 0.0, off = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const direction wi = gonio::spherical_direction(polar(random), azimuth(random));
    const direction wo = gonio::spherical_direction(polar(random), azimuth(random));
    const rgb expected = paint(wi, wo);
    sum += expected.sum();
    off += (horizon_lookup(paint)(wi, wo) - expected).abs().sum();
  }
  CHECK(off < 0.005 * sum);
}
