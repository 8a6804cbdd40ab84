#pragma once
/// Bodies of render/sphere.hpp.

#include <gonio/core/brdf.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/render/image.hpp>
#include <gonio/render/lighting.hpp>
#include <gonio/render/sphere.hpp>
#include <gonio/table/brdf_table.hpp>

#include <cstdint>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

namespace gonio::render {

GONIO_INLINE std::vector<sphere_point> sphere_points(int size) {
  GONIO_ASSERT(size >= 1);
  std::vector<sphere_point> points;
  const auto centre = [size](int i) { return (i + 0.5) / size * 2.0 - 1.0; };
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) {
      const double x = centre(column), y = -centre(row);
      const double squared_radius = x * x + y * y;
      if (!(squared_radius < 1.0)) continue;
      points.push_back({static_cast<std::uint32_t>(row),
                        static_cast<std::uint32_t>(column),
                        {x, y, std::sqrt(1.0 - squared_radius)}});
    }
  return points;
}

GONIO_INLINE sphere_colours sphere_operator::apply(const brdf_table& table, thread_count threads) const {
  if (!(table.cells() == cells_))
    refuse("a sphere operator over " + std::to_string(cells_.size()) + " cells was given a table over other cells (" +
           std::to_string(table.cells().size()) + " of them)");
  sphere_colours colours(std::ssize(rows_), 3);
  for_each_index(
      rows_.size(), detail::sphere_block,
      [&](Eigen::Index point) { colours.row(point) = radiance(rows_[point], table.values()).transpose(); }, threads);
  return colours;
}

GONIO_INLINE image sphere_operator::to_image(const sphere_colours& colours, const rgb& background) const {
  GONIO_ASSERT(colours.rows() == std::ssize(points_));
  const Eigen::Index side = size_;
  image picture = uniform_image(side, side, background);
  for (Eigen::Index point = 0; point < std::ssize(points_); ++point)
    set_pixel(picture, points_[point].row, points_[point].column, colours.row(point).transpose());
  return picture;
}

}  // namespace gonio::render
