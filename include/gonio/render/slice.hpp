#pragma once
/// The slice of a BRDF at phi_d = 90 degrees: one image that separates diffuse colour, highlight, Fresnel effect and
/// retro-reflection. B. Burley, "Physically-Based Shading at Disney", SIGGRAPH 2012 course; J. B. Nielsen's
/// thesis (2016), Sec. 2.2.3 and Fig. 2.8.

#include <gonio/core/brdf.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/render/image.hpp>
#include <gonio/table/grid.hpp>

#include <numbers>

namespace gonio::render {

/// The scale of theta_h along the horizontal axis of the image.
enum class slice_axis {
  /// Steps of sqrt(theta_h), as in MERL's tables: a highlight of a few degrees fills a quarter of the image.
  square_root,
  /// Steps of theta_h.
  linear,
};

/// The size and scale of a slice.
struct slice_view {
  int rows = 90;
  int columns = 90;
  slice_axis axis = slice_axis::square_root;
};

/// Returns theta_h and theta_d at a pixel's centre, and phi_d = 90 degrees, in radians. Row 0 is at the top.
[[nodiscard]] inline half_difference slice_angles(const slice_view& view, Eigen::Index row, Eigen::Index column) {
  GONIO_ASSERT(row >= 0 && row < view.rows && column >= 0 && column < view.columns);
  const grid nodes({view.columns, view.rows, 1}, cell_anchor::centre);
  constexpr double right_angle = std::numbers::pi / 2.0;
  const double theta_h = view.axis == slice_axis::square_root
                             ? nodes.theta_h(static_cast<int>(column))
                             : (static_cast<double>(column) + 0.5) / view.columns * right_angle;
  return {theta_h, nodes.theta_d(view.rows - 1 - static_cast<int>(row)), right_angle};
}

/// Returns f * pi over theta_h (along x, 0 at the left) and theta_d (along y, 0 at the bottom), both from 0 to 90
/// degrees, at pixel centres. The factor pi shows a white Lambertian surface as white; nothing is clipped. Grazing
/// reflection is in the top row, mirror reflection in the left column, retro-reflection at the bottom. All pixels are
/// above the horizon. With MERL's grid, the default image has one pixel for each cell. With a nearest_lookup, the
/// grazing corner at the top right is black, because its cells are at 90.5 degrees.
template <brdf Brdf>
[[nodiscard]] image render_slice(const Brdf& f, const slice_view& view = {}, thread_count threads = {}) {
  GONIO_ASSERT(view.rows >= 1 && view.columns >= 1);
  const std::size_t rows = view.rows, columns = view.columns;
  image picture({rows, columns, std::size_t{3}});
  for_each_block(
      rows, 1,
      [&](block range) {
        const auto row = range.begin;
        for (int column = 0; column < view.columns; ++column) {
          const auto [wi, wo] = to_directions(slice_angles(view, row, column));
          set_pixel(picture, row, column, std::numbers::pi * rgb(f(wi, wo)));
        }
      },
      threads);
  return picture;
}

}  // namespace gonio::render
