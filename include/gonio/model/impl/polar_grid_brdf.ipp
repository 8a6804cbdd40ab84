#pragma once
/// Bodies of model/polar_grid_brdf.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/model/polar_grid_brdf.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

namespace gonio::model {

namespace detail {

/// The two cells whose centres enclose an angle, and their weights.
struct neighbouring_cells {
  std::array<Eigen::Index, 2> cell;
  std::array<double, 2> weight;

  neighbouring_cells(double angle, double full, Eigen::Index cells) noexcept {
    const double last = static_cast<double>(cells - 1);
    const double at = std::clamp(angle / full * static_cast<double>(cells) - 0.5, 0.0, last);
    const double below = std::floor(at);
    cell[0] = static_cast<Eigen::Index>(below);
    cell[1] = std::min(cell[0] + 1, cells - 1);
    weight[1] = at - below;
    weight[0] = 1.0 - weight[1];
  }
};

/// Returns the angle between two azimuths, from 0 to pi. If a direction is the normal, returns pi, as for the mirror
/// direction.
[[nodiscard]] inline double azimuth_between(const direction& wi, const direction& wo) noexcept {
  const double across = std::abs(wi.x() * wo.y() - wi.y() * wo.x()), along = wi.x() * wo.x() + wi.y() * wo.y();
  return across == 0.0 && along == 0.0 ? std::numbers::pi : std::atan2(across, along);
}

}  // namespace detail

GONIO_INLINE polar_grid_brdf::polar_grid_brdf(const polar_grid& grid, std::vector<float> values) : grid_(grid) {
  // Divide where a product might overflow. Products up to `count`, the number of values in memory, cannot.
  const Eigen::Index count = std::ssize(values);
  if (grid.polar < 1 || grid.azimuth < 1 || grid.polar > count || grid.azimuth > count ||
      grid.polar > count / grid.polar || grid.azimuth > count / (grid.polar * grid.polar) ||
      (count != grid.size() && count != 3 * grid.size()))
    refuse({"a polar grid of ", grid.polar, " x ", grid.polar, " x ", grid.azimuth,
            " cells needs one or three values for each cell, not ", count, " in all"});
  for (Eigen::Index i = 0; i < count; ++i)
    if (!std::isfinite(values[i])) refuse({"value ", i, " of a polar grid is not finite"});
  channels_ = count / grid.size();
  values_ = std::make_shared<const std::vector<float>>(std::move(values));
}

GONIO_INLINE rgb polar_grid_brdf::as_measured(const direction& wi, const direction& wo) const noexcept {
  if (!(wi.z() > 0.0 && wo.z() > 0.0)) return rgb::Zero();
  constexpr double pi = std::numbers::pi;
  const detail::neighbouring_cells i(polar_angle(wi), 0.5 * pi, grid_.polar);
  const detail::neighbouring_cells o(polar_angle(wo), 0.5 * pi, grid_.polar);
  const detail::neighbouring_cells phi(detail::azimuth_between(wi, wo), pi, grid_.azimuth);
  rgb sum = rgb::Zero();
  for (int corner = 0; corner < 8; ++corner) {
    const int a = corner / 4, b = corner / 2 % 2, c = corner % 2;
    const Eigen::Index cell = (i.cell[a] * grid_.polar + o.cell[b]) * grid_.azimuth + phi.cell[c];
    const float* value = values_->data() + channels_ * cell;
    const double weight = i.weight[a] * o.weight[b] * phi.weight[c];
    for (Eigen::Index channel = 0; channel < 3; ++channel)
      sum[channel] += weight * double{value[channels_ == 1 ? 0 : channel]};
  }
  return sum;
}

GONIO_INLINE direction_pair directions_of(const polar_grid& grid, Eigen::Index cell) noexcept {
  const auto centre = [](Eigen::Index number, Eigen::Index cells, double full) {
    return (static_cast<double>(number) + 0.5) / static_cast<double>(cells) * full;
  };
  constexpr double pi = std::numbers::pi;
  const Eigen::Index row = cell / grid.azimuth;
  const double phi = centre(cell % grid.azimuth, grid.azimuth, pi);
  return {spherical_direction(centre(row / grid.polar, grid.polar, 0.5 * pi), 0.0),
          spherical_direction(centre(row % grid.polar, grid.polar, 0.5 * pi), phi)};
}

GONIO_INLINE void require_polar_grid(const polar_grid& grid) {
  if (grid.polar < 1 || grid.azimuth < 1 || grid.polar > 360 || grid.azimuth > 720)
    refuse({"a polar grid needs 1 to 360 cells of theta and 1 to 720 of phi, not ", grid.polar, " and ", grid.azimuth});
}

}  // namespace gonio::model
