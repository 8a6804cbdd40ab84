#pragma once
/// Orthographic images of a sphere with any BRDF. For many tables, `sphere_operator` is faster: the image as a linear
/// map of a table's values.
///
/// Pixel centres form a regular grid over the square around the unit disc. Pixel centres strictly inside the disc
/// belong to the sphere (1020 of 36 x 36). Exposure: the lighting is scaled so that a white Lambertian sphere (f =
/// 1/pi) has mean luminance 1 over the sphere's pixels. The exposure does not depend on the BRDF.

#include <gonio/core/brdf.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/render/image.hpp>
#include <gonio/render/lighting.hpp>
#include <gonio/table/brdf_table.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

namespace gonio::render {

/// The camera's view of the sphere.
struct sphere_view {
  /// Rows and columns of the image.
  int size = 256;
  /// Samples per pixel along each axis.
  int supersampling = 1;
  /// The colour around the sphere. With supersampling, partly covered pixels blend sphere and background.
  rgb background = rgb::Zero();
  /// For an anisotropic BRDF: its x axis runs about the vertical axis, as grooves do on a turned sphere. Otherwise its
  /// x axis is arbitrary.
  bool is_turned = false;
};

/// A point of the sphere that a sample of the image sees.
struct sphere_point {
  std::uint32_t row = 0;
  std::uint32_t column = 0;
  /// The surface normal in world axes, as in render/lighting.hpp.
  direction normal;
};

/// Returns the samples of a size x size grid that lie on the sphere, row by row from the top.
[[nodiscard]] std::vector<sphere_point> sphere_points(int size);

namespace detail {

/// Number of samples that a thread computes at a time.
inline constexpr Eigen::Index sphere_block = 32;

/// If asked for, converts directions from `surface_frame{normal}`, the frame of lights, to a frame around the vertical
/// axis.
class turned_axes {
 public:
  turned_axes(const direction& normal, bool is_turned) : is_turned_(is_turned) {
    if (!is_turned) return;
    const direction x = surface_frame(normal).to_local(surface_frame::around(direction::UnitY(), normal).tangent);
    cosine_ = x.x();
    sine_ = x.y();
  }
  [[nodiscard]] direction of(const direction& w) const noexcept {
    if (!is_turned_) return w;
    return {cosine_ * w.x() + sine_ * w.y(), cosine_ * w.y() - sine_ * w.x(), w.z()};
  }

 private:
  bool is_turned_;
  double cosine_ = 1.0, sine_ = 0.0;
};

/// Returns the factor that scales the mean luminance of a white sphere's points to 1. Returns 1 if no light reaches the
/// sphere.
[[nodiscard]] inline double exposure_from(const std::vector<double>& white_luminances) noexcept {
  const double sum = std::accumulate(white_luminances.begin(), white_luminances.end(), 0.0);
  return sum > 0.0 ? static_cast<double>(white_luminances.size()) / sum : 1.0;
}

}  // namespace detail

/// Renders an image of a sphere in linear light. The bytes do not depend on the number of threads.
template <brdf Brdf, sphere_lighting Lighting>
[[nodiscard]] image render_sphere(const Brdf& f, const Lighting& lighting, const sphere_view& view = {},
                                  thread_count threads = {}) {
  GONIO_ASSERT(view.supersampling >= 1);
  const std::vector<sphere_point> points = sphere_points(view.size * view.supersampling);
  std::vector<rgb> radiance(points.size(), rgb::Zero());
  std::vector<double> white(points.size());
  for_each_index(
      points.size(), detail::sphere_block,
      [&](Eigen::Index point) {
        const detail::turned_axes axes(points[point].normal, view.is_turned);
        lighting.for_each_incident(points[point].normal,
                                   [&](const direction& wi, const direction& wo, const rgb& weight) {
                                     radiance[point] += rgb(f(axes.of(wi), axes.of(wo))) * weight;
                                     white[point] += luminance(weight) * std::numbers::inv_pi;
                                   });
      },
      threads);

  // Replace each sample's part of the background by the light from the sphere.
  const std::size_t side = view.size;
  const auto samples = static_cast<std::uint32_t>(view.supersampling);
  const double exposure = detail::exposure_from(white);
  std::vector<rgb> pixels(side * side, view.background);
  for (Eigen::Index point = 0; point < std::ssize(points); ++point) {
    const Eigen::Index row = points[point].row / samples, column = points[point].column / samples;
    pixels[row * side + column] += (exposure * radiance[point] - view.background) / (samples * samples);
  }
  image picture({side, side, std::size_t{3}});
  for (Eigen::Index i = 0; i < std::ssize(pixels); ++i) set_pixel(picture, i / side, i % side, pixels[i]);
  return picture;
}

/// One colour for each point of a sphere, in the order of `sphere_points`; linear light.
using sphere_colours = Eigen::Array<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// The image of a sphere as a sparse linear map of the values of a table over given cells. Each direction takes the
/// value of the nearest cell; a direction whose cell is invalid contributes nothing. `apply(table)` equals
/// `render_sphere(nearest_lookup{table}, ...)` up to the rounding of weights to float.
///
/// Memory: 16 bytes per incident direction and point; 73 MB for the default environment at 36 x 36 points, 14 kB
/// for two lights.
class sphere_operator {
 public:
  /// Enumerates the incident light once, on several threads.
  template <sphere_lighting Lighting>
  sphere_operator(valid_cells cells, const Lighting& lighting, int size = 36, thread_count threads = {})
      : cells_(std::move(cells)), size_(size), points_(sphere_points(size)), rows_(points_.size()) {
    std::vector<double> white(points_.size());
    for_each_block(
        points_.size(), detail::sphere_block,
        [&](block range) {
          std::vector<entry> row;
          for (Eigen::Index point = range.begin; point < range.end; ++point) {
            row.clear();
            lighting.for_each_incident(points_[point].normal,
                                       [&](const direction& wi, const direction& wo, const rgb& weight) {
                                         row.push_back(entry_of(wi, wo, weight));
                                         white[point] += luminance(weight) * std::numbers::inv_pi;
                                       });
            // Number the valid cells in a separate loop, in which the processor can overlap the cache misses.
            std::erase_if(row, [&](const entry& e) { return !cells_.contains(e.cell); });
            for (entry& e : row) e.cell = static_cast<std::uint32_t>(cells_.representative(e.cell));
            rows_[point].assign(row.begin(), row.end());
          }
        },
        threads);
    exposure_ = detail::exposure_from(white);
  }

  [[nodiscard]] const valid_cells& cells() const noexcept { return cells_; }

  /// Returns the points of the sphere, in the order in which `apply` returns their colours.
  [[nodiscard]] const std::vector<sphere_point>& points() const noexcept { return points_; }

  /// Returns the number of non-zero entries for each of the three channels.
  [[nodiscard]] Eigen::Index entries() const noexcept {
    return std::accumulate(rows_.begin(), rows_.end(), Eigen::Index{0},
                           [](Eigen::Index sum, const std::vector<entry>& row) { return sum + row.size(); });
  }

  /// Calls `visit(cell, weight)` for each cell that reflects light at a point. The point's colour is the sum of
  /// reflectance times weight.
  template <class Visit>
  void for_each_entry(Eigen::Index point, Visit&& visit) const {
    GONIO_ASSERT(point < std::ssize(rows_));
    for (const auto& [cell, weight] : rows_[point])
      visit(Eigen::Index{cell}, rgb(exposure_ * rgb(weight[0], weight[1], weight[2])));
  }

  /// Returns the colours of a sphere with this table. The bytes do not depend on the number of threads. Throws
  /// gonio::error if the table is over other cells.
  [[nodiscard]] sphere_colours apply(const brdf_table& table, thread_count threads = {}) const;

  /// Returns the colours as an image.
  [[nodiscard]] image to_image(const sphere_colours& colours, const rgb& background = rgb::Zero()) const;

 private:
  struct entry {
    std::uint32_t cell;
    std::array<float, 3> weight;
  };

  [[nodiscard]] entry entry_of(const direction& wi, const direction& wo, const rgb& weight) const noexcept {
    const Eigen::Index linear = cells_.grid().linear(cells_.grid().nearest(to_half_difference(wi, wo)));
    return {static_cast<std::uint32_t>(linear),
            {static_cast<float>(weight.x()), static_cast<float>(weight.y()), static_cast<float>(weight.z())}};
  }

  [[nodiscard]] rgb radiance(const std::vector<entry>& row, std::span<const float> values) const noexcept {
    rgb sum = rgb::Zero();
    for (const auto& [cell, weight] : row) {
      const float* value = values.data() + 3 * Eigen::Index{cell};
      sum += rgb(value[0], value[1], value[2]) * rgb(weight[0], weight[1], weight[2]);
    }
    return exposure_ * sum;
  }

  valid_cells cells_;
  int size_;
  std::vector<sphere_point> points_;
  std::vector<std::vector<entry>> rows_;
  double exposure_ = 1.0;
};

}  // namespace gonio::render

#if !defined(GONIO_COMPILED)
#include <gonio/render/impl/sphere.ipp>
#endif
