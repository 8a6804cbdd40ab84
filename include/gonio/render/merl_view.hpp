#pragma once
/// A view of a MERL table in a renderer's memory, without a copy. The grid is from Matusik et al., "A Data-Driven
/// Reflectance Model", SIGGRAPH 2003 (doi:10.1145/882262.882343). A `lookup_table` is smaller and faster, because it
/// stores the three channels of a cell together.

#include <gonio/core/brdf.hpp>
#include <gonio/render/cell_finder.hpp>
#include <gonio/render/grid_coordinates.hpp>
#include <gonio/render/horizon_index.hpp>
#include <gonio/render/lookup_table.hpp>
#include <gonio/table/table_convention.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <concepts>
#include <span>
#include <string>
#include <vector>

namespace gonio::render {

/// A view of three planes of red, green and blue in the scale of MERL's files, phi_d fastest and theta_h slowest. The
/// planes must outlive it. The view reads them like `lookup_table::from_merl`: negative values, which mark cells
/// without a value, are black, and cells below the horizon repeat cells above it. The view holds an index of the grid,
/// 100 KB. After construction it does not allocate, lock or throw, and any number of threads may read.
/// ```cpp
/// const gonio::render::merl_view paint(planes);  // the file's data after its header, 3 x 90 x 90 x 180
/// const auto f = paint(wi, wo);  // sr^-1, without the cosine, in float or double like the directions
/// ```
/// Values are not checked in advance. A value that is not finite is returned as it is.
template <interpolation Interpolation = interpolation::nearest>
class merl_view {
 public:
  /// O(cells of the grid). Infers the position of the values within their cells from the cells without a value
  /// (`infer_convention`), as in `read_merl`. Throws gonio::error if the planes do not have the grid's size.
  explicit merl_view(std::span<const double> planes, const grid_extents& extents = {})
      : merl_view(planes, gonio::grid(extents, infer_convention(planes, extents).anchor)) {}
  /// Takes a grid with a known anchor. Throws gonio::error if the planes do not have the grid's size.
  merl_view(std::span<const double> planes, const gonio::grid& cells) : planes_(planes), index_(cells), finder_(cells) {
    if (std::ssize(planes) != 3 * cells.size())
      refuse("a MERL table needs three planes of " + std::to_string(cells.size()) + " values, not " +
             std::to_string(planes.size()) + " values");
  }
  /// Deleted, because a view must not outlive its planes.
  explicit merl_view(std::vector<double>&& planes, const grid_extents& extents = {}) = delete;
  merl_view(std::vector<double>&& planes, const gonio::grid& cells) = delete;

  /// Returns reflectance in sr^-1 for a pair in `float` or `double`.
  template <std::floating_point Real>
  [[nodiscard]] Eigen::Array<Real, 3, 1> operator()(const Eigen::Matrix<Real, 3, 1>& wi,
                                                    const Eigen::Matrix<Real, 3, 1>& wo) const noexcept {
    const Real ix = wi[0], iy = wi[1], iz = wi[2], ox = wo[0], oy = wo[1], oz = wo[2];
    Eigen::Array<Real, 3, 1> sum = Eigen::Array<Real, 3, 1>::Zero();
    if (!is_above_horizon(ix, iy, iz, ox, oy, oz)) return sum;
    if constexpr (Interpolation == interpolation::nearest) {
      const auto cell = finder_.find(ix, iy, iz, ox, oy, oz);
      return value<Real>(index_.linear(cell.theta_h, cell.theta_d, cell.phi_d));
    } else {
      const auto corners = index_.around(to_grid_coordinates(ix, iy, iz, ox, oy, oz),
                                         [this](auto... node) { return index_.linear(node...); });
      for (Eigen::Index k = 0; k < 8; ++k) sum += corners.weight[k] * value<Real>(corners.number[k]);
      return sum;
    }
  }

  [[nodiscard]] const gonio::grid& grid() const noexcept { return index_.grid(); }

  /// Returns the planes that it views.
  [[nodiscard]] std::span<const double> planes() const noexcept { return planes_; }

 private:
  template <std::floating_point Real>
  [[nodiscard]] Eigen::Array<Real, 3, 1> value(Eigen::Index linear) const noexcept {
    Eigen::Array<Real, 3, 1> colour;
    for (Eigen::Index channel = 0; channel < 3; ++channel)
      colour[channel] =
          static_cast<Real>(std::max(planes_[channel * grid().size() + linear] * merl_scale[channel], 0.0));
    return colour;
  }

  std::span<const double> planes_;
  horizon_index index_;
  cell_finder<double> finder_;
};

static_assert(brdf<merl_view<>>);

}  // namespace gonio::render
