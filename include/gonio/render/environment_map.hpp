#pragma once
/// Light from all directions as a latitude-longitude image (P. Debevec, "Rendering Synthetic Objects into Real Scenes",
/// SIGGRAPH 1998, doi:10.1145/280814.280864), and as directional lights: one for each pixel, or a few drawn by
/// importance along a Hilbert curve (M. Steigleder and M. McCool, "Generalized Stratified Sampling Using the Hilbert
/// Curve", Journal of Graphics Tools 8(3), 2003). Noell et al. 2014, Sec. 3.1, evaluate BRDFs in such light: spheres in
/// Debevec's Grace Cathedral.

#include <gonio/core/error.hpp>
#include <gonio/render/grid_coordinates.hpp>
#include <gonio/render/image.hpp>
#include <gonio/render/lighting.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace gonio::render {

/// Radiance from all directions, constant within each pixel of an image that is twice as wide as high.
///
/// The image is the view of an upright observer at the sphere who turns around. World axes are as in
/// render/lighting.hpp. The convention is as in Debevec's High-Resolution Light Probe Image Gallery. The centre is
/// behind the sphere, in the camera's viewing direction (-z). The left and right edges are behind the camera (+z). A
/// quarter from the right is the camera's right (+x). The top row is up (+y). The point u from left to right and v from
/// top to bottom is the direction (sin t sin l, cos t, -sin t cos l) with t = pi v, l = 2 pi u - pi.
class environment_map {
 public:
  /// Takes an image of linear radiance. Throws gonio::error unless it has shape (n, 2 n, 3), every value is finite and
  /// not negative, and at least one is positive. O(pixels).
  explicit environment_map(gonio::image latitude_longitude);

  /// Tabulates a function of world directions at the pixel centres. `environment_map::of(formula_environment{})` needs
  /// no light probe. Throws gonio::error as the constructor does.
  template <class Radiance>
  requires std::is_invocable_r_v<rgb, const Radiance&, const direction&>
  [[nodiscard]] static environment_map of(const Radiance& radiance, std::size_t rows = 256) {
    gonio::image tabulated({rows, 2 * rows, std::size_t{3}});
    for (std::size_t row = 0; row < rows; ++row)
      for (std::size_t column = 0; column < 2 * rows; ++column)
        set_pixel(tabulated, row, column, radiance(towards(row, column, rows)));
    return environment_map(std::move(tabulated));
  }

  [[nodiscard]] const gonio::image& image() const noexcept { return image_; }
  [[nodiscard]] std::size_t rows() const noexcept { return image_.shape(0); }
  [[nodiscard]] std::size_t columns() const noexcept { return image_.shape(1); }

  /// Returns the radiance from a world direction, which must not be zero and may have any length.
  [[nodiscard]] rgb operator()(const direction& d) const noexcept {
    // In units of pi: the angle downwards from +y, and the angle around from +z (the left edge).
    const double down = half_turns(d.y(), std::sqrt(d.x() * d.x() + d.z() * d.z()));
    const double around = half_turns(-d.z(), d.x()) + (std::signbit(d.x()) ? 0.0 : 1.0);
    // The south pole is at the far edge of the last row. The direction +z, if reached from the left, is at the far edge
    // of the last column.
    const auto row = std::min(static_cast<std::size_t>(down * static_cast<double>(rows())), rows() - 1);
    const auto column = std::min(static_cast<std::size_t>(around * static_cast<double>(rows())), columns() - 1);
    return pixel(image_, row, column);
  }

  /// Returns the unit vector towards the centre of a pixel.
  [[nodiscard]] direction towards(std::size_t row, std::size_t column) const noexcept {
    return towards(row, column, rows());
  }

  /// The direction of a row: cosine (`along`) and sine (`across`) of its angle from +y (up).
  struct height {
    double along = 0.0, across = 0.0;
  };
  /// Returns the unit vector of a height and a position along the row, in columns from the left edge of the image.
  [[nodiscard]] static direction towards(const height& up, double column, std::size_t rows) noexcept {
    const double longitude = column * std::numbers::pi / static_cast<double>(rows) - std::numbers::pi;
    return {up.across * std::sin(longitude), up.along, -up.across * std::cos(longitude)};
  }

  /// Returns the exact solid angle of each pixel of a row, in sr.
  [[nodiscard]] double solid_angle(std::size_t row) const noexcept { return row_solid_angles_[row]; }

  /// Returns radiance times solid angle of a pixel: the irradiance of a surface that faces it.
  [[nodiscard]] rgb irradiance(std::size_t row, std::size_t column) const noexcept {
    return solid_angle(row) * pixel(image_, row, column);
  }

 private:
  [[nodiscard]] static direction towards(std::size_t row, std::size_t column, std::size_t rows) noexcept {
    const double step = std::numbers::pi / static_cast<double>(rows);
    const double polar = (static_cast<double>(row) + 0.5) * step;
    return towards({std::cos(polar), std::sin(polar)}, static_cast<double>(column) + 0.5, rows);
  }

  /// Returns the azimuth of a point from the x axis in units of pi. For a point below the axis, returns the azimuth of
  /// the opposite point.
  [[nodiscard]] static double half_turns(double x, double y) noexcept {
    const detail::azimuth_terms<double> phi(x, y);
    return detail::half_turns(detail::quarter_turns(phi.tangent, phi.tangent * phi.tangent, phi.steep), phi.left);
  }

  void check_shape() const;

  void check_values() const;

  gonio::image image_;
  std::vector<double> row_solid_angles_;
};

/// Returns every pixel that is not black as a directional light, in row-major order. Brute force: O(pixels) for each
/// point of a sphere.
[[nodiscard]] directional_lighting all_lights(const environment_map& map);

namespace detail {

/// Calls `visit(row, column)` for all pixels along Hilbert's curve. The curve fills the smallest square that contains
/// the image and whose side is a power of two. Pixels that are near each other on the curve are near each other in the
/// image.
template <class Visit>
void for_each_along_hilbert_curve(std::size_t rows, std::size_t columns, Visit&& visit) {
  const std::size_t side = std::bit_ceil(std::max(rows, columns));
  for (std::size_t position = 0; position < side * side; ++position) {
    // At each level, from the finest, two bits of `position` choose a quadrant, and the part of the curve inside it is
    // rotated to fit. The curve fills the upper half of the square first. In an image twice as wide as high, whose
    // width is a power of two, successive pixels are therefore adjacent.
    std::size_t row = 0, column = 0, rest = position;
    for (std::size_t half = 1; half < side; half *= 2, rest /= 4) {
      const bool lower = (rest & 2) != 0, right = lower != ((rest & 1) != 0);
      if (!right) {
        if (lower) row = half - 1 - row, column = half - 1 - column;
        std::swap(row, column);
      }
      if (lower) row += half;
      if (right) column += half;
    }
    if (row < rows && column < columns) visit(row, column);
  }
}

/// Returns one number in each of [0, 1), [1, 2), ... [count - 1, count), the same on every platform.
[[nodiscard]] std::vector<double> stratified_draws(std::size_t count, std::uint64_t seed);

}  // namespace detail

/// Approximates the map by directional lights. Draws `count` pixels with probability proportional to luminance times
/// solid angle, one in each of `count` equal strata along a Hilbert curve. Each light has the pixel's radiance * solid
/// angle / (count * probability), so all have the same luminance. A pixel that is drawn n times becomes one light, n
/// times as bright. The expected image over seeds is the image under `all_lights`.
///
/// Rough surfaces need fewer lights. A mirror shows each light as a dot for any affordable number of lights; for
/// mirrors, use `environment_lighting(90, 72, map)`, whose bins are dense at highlights.
///
/// Throws gonio::error if count is 0. O(pixels). The result depends only on `seed`.
[[nodiscard]] directional_lighting important_lights(const environment_map& map, std::size_t count, std::uint64_t seed);

static_assert(std::is_invocable_r_v<rgb, const environment_map&, const direction&>);
static_assert(sphere_lighting<environment_lighting<environment_map>>);

}  // namespace gonio::render

#if !defined(GONIO_COMPILED)
#include <gonio/render/impl/environment_map.ipp>
#endif
