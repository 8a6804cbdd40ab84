#include <gonio/render/slice.hpp>
#include <gonio/table/brdf_table.hpp>

#include <doctest/doctest.h>

using gonio::direction;
using gonio::image;
using gonio::pixel;
using gonio::rgb;
using gonio::render::slice_axis;

namespace {

constexpr double pi = std::numbers::pi;

/// Returns the angles of evaluation as a colour.
struct angles_as_colour {
  rgb operator()(const direction& wi, const direction& wo) const noexcept {
    const auto angles = gonio::to_half_difference(wi, wo);
    return {angles.theta_h, angles.theta_d, angles.phi_d};
  }
};

struct white_lambertian {
  rgb operator()(const direction& wi, const direction& wo) const noexcept {
    return rgb::Constant(wi.z() > 0 && wo.z() > 0 ? std::numbers::inv_pi : 0.0);
  }
};

}  // namespace

TEST_CASE("theta_h runs to the right and theta_d upwards, at pixel centres, at phi_d = 90 degrees") {
  const image root = gonio::render::render_slice(angles_as_colour(), {.rows = 6, .columns = 9});
  const image linear =
      gonio::render::render_slice(angles_as_colour(), {.rows = 6, .columns = 9, .axis = slice_axis::linear});
  REQUIRE(root.shape(0) == 6);
  REQUIRE(root.shape(1) == 9);
  for (std::size_t row = 0; row < 6; ++row)
    for (std::size_t column = 0; column < 9; ++column) {
      const double x = (static_cast<double>(column) + 0.5) / 9.0, y = (5.5 - static_cast<double>(row)) / 6.0;
      const rgb expected(x * x * pi / 2.0, y * pi / 2.0, pi / 2.0);
      CHECK((pixel(root, row, column) / pi - expected).abs().maxCoeff() < 1e-6);  // pixels are floats
      CHECK((pixel(linear, row, column) / pi - rgb(x * pi / 2.0, expected.y(), expected.z())).abs().maxCoeff() < 1e-6);
      const auto angles = gonio::render::slice_angles({.rows = 6, .columns = 9}, row, column);
      CHECK((rgb(angles.theta_h, angles.theta_d, angles.phi_d) - expected).abs().maxCoeff() < 1e-12);
    }
}

TEST_CASE("the slice of a white Lambertian surface is white everywhere: all of it is above the horizon") {
  for (const auto axis : {slice_axis::square_root, slice_axis::linear})
    for (const float value : gonio::render::render_slice(white_lambertian(), {.axis = axis}))
      CHECK(value == doctest::Approx(1.0).epsilon(1e-6));
}

TEST_CASE("the default slice has one pixel for each cell of MERL's grid") {
  const gonio::valid_cells cells;
  gonio::brdf_table table(cells);
  for (Eigen::Index cell = 0; cell < cells.size(); ++cell) {
    const auto index = cells.grid().cell(cells.linear(cell));
    // The two cells on either side of 90 degrees are blue: 89 is at 89.5 degrees, 90 at 90.5.
    table.set(cell, rgb(index.theta_h, index.theta_d, index.phi_d == 89 || index.phi_d == 90 ? 1.0 : 0.0));
  }
  const image picture = gonio::render::render_slice(gonio::nearest_lookup(table));
  REQUIRE(picture.shape(0) == 90);
  REQUIRE(picture.shape(1) == 90);
  for (std::size_t row = 0; row < 90; ++row)
    for (std::size_t column = 0; column < 90; ++column) {
      CAPTURE(row);
      CAPTURE(column);
      // Cells at 89.5 and 90.5 degrees are valid or invalid together: both cosines have the magnitude 0.009.
      const auto linear = cells.grid().linear({static_cast<int>(column), 89 - static_cast<int>(row), 90});
      const rgb expected = cells.contains(linear)
                               ? rgb(static_cast<double>(column), 89.0 - static_cast<double>(row), 1.0)
                               : rgb(rgb::Zero());
      REQUIRE((pixel(picture, row, column) / pi - expected).abs().maxCoeff() < 1e-5);
    }
}

TEST_CASE("the number of threads does not change a byte of a slice") {
  CHECK(gonio::render::render_slice(angles_as_colour(), {}, {1}) ==
        gonio::render::render_slice(angles_as_colour(), {}, {5}));
}
