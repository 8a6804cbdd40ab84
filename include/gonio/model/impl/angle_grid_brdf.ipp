#pragma once
/// Bodies of model/angle_grid_brdf.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/model/angle_grid_brdf.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

namespace gonio::model::detail {

inline constexpr double full_turn = 2.0 * std::numbers::pi;

GONIO_INLINE direction direction_about_specular(double theta, double phi, double radial, double azimuth) noexcept {
  // In the plane of incidence, with light from +x: the specular direction, and the direction from it towards the
  // normal.
  const direction specular{-std::sin(theta), 0.0, std::cos(theta)}, to_normal{std::cos(theta), 0.0, std::sin(theta)};
  const double across = std::sin(radial);
  direction w = gonio::detail::combined(std::cos(radial), specular, across * std::cos(azimuth), to_normal);
  w.y() = across * std::sin(azimuth);
  return turned_about_normal(w, phi);
}

/// The inverse: returns the radial angle and the azimuth of a viewer.
[[nodiscard]] inline std::pair<double, double> angles_about_specular(double theta, double phi,
                                                                     const direction& wo) noexcept {
  const direction w = turned_about_normal(wo, -phi);
  const double along = std::cos(theta) * w.z() - std::sin(theta) * w.x(),
               up = std::cos(theta) * w.x() + std::sin(theta) * w.z();
  return {std::atan2(std::hypot(up, w.y()), along), std::atan2(w.y(), up)};
}

[[nodiscard]] inline angle_axis::kind kind_of_azimuths(const std::vector<double>& nodes) {
  const bool is_half =
      nodes.size() > 1 && nodes.front() >= 0.0 && nodes.back() - nodes.front() <= std::numbers::pi + 1e-9;
  return is_half ? angle_axis::kind::half_turn : angle_axis::kind::full_turn;
}

GONIO_INLINE angle_axis::angle_axis(const std::vector<double>& nodes, kind of) : nodes_(nodes), kind_(of) {}

GONIO_INLINE axis_neighbours angle_axis::find(double angle) const noexcept {
  const auto last = static_cast<Eigen::Index>(nodes_.size()) - 1;
  if (last == 0) return {};
  if (kind_ == kind::half_turn) angle = std::abs(std::remainder(angle, full_turn));
  if (kind_ == kind::full_turn) {
    angle -= full_turn * std::floor((angle - nodes_.front()) / full_turn);
    if (angle > nodes_.back()) {  // between the last and, a turn later, the first
      const double gap = nodes_.front() + full_turn - nodes_.back();
      const double share = gap > 0.0 ? std::clamp((angle - nodes_.back()) / gap, 0.0, 1.0) : 0.0;
      return {last, 0, 1.0 - share, share};
    }
  }
  const auto next = std::upper_bound(nodes_.begin() + 1, nodes_.end() - 1, angle);
  const auto first = static_cast<Eigen::Index>(next - nodes_.begin()) - 1;
  double share = (angle - nodes_[first]) / (nodes_[first + 1] - nodes_[first]);
  if (kind_ != kind::extrapolated) share = std::min(std::max(0.0, share), 1.0);
  return {first, first + 1, 1.0 - share, share};
}

inline void require_axis(const std::vector<double>& nodes, const char* name, std::size_t fewest, double lowest,
                         double highest) {
  constexpr double rounding = 1e-9;
  const auto possible = [&](double angle) { return angle >= lowest - rounding && angle <= highest + rounding; };
  if (nodes.size() < fewest || !std::ranges::all_of(nodes, possible) ||
      std::ranges::adjacent_find(nodes, std::ranges::greater_equal()) != nodes.end())
    refuse({"a grid of angles needs at least ", fewest, " ascending angles of ", name, ", from ", degrees(lowest),
            " to ", degrees(highest), " degrees"});
}

inline void require_grid(const angle_grid& grid) {
  constexpr double quarter = 0.25 * full_turn;
  require_axis(grid.phi_i, "the light's azimuth", 1, -full_turn, full_turn);
  require_axis(grid.theta_i, "incidence", 1, 0.0, quarter);
  require_axis(grid.viewer_azimuth, "the viewer's azimuth", 1, -full_turn, full_turn);
  require_axis(grid.viewer_polar, "the viewer's polar or radial angle", 1, 0.0, 2.0 * quarter);
  for (const std::vector<double>* azimuths : {&grid.phi_i, &grid.viewer_azimuth})
    if (azimuths->back() - azimuths->front() >= full_turn - 1e-9) refuse("the azimuths of a grid exceed a full turn");
  if (std::ssize(grid.values) != 3 * grid.size())
    refuse({"a grid of ", grid.size(), " pairs of directions needs ", 3 * grid.size(), " values, not ",
            grid.values.size()});
  const auto bad = std::ranges::find_if(grid.values, [](float value) { return !std::isfinite(value); });
  if (bad != grid.values.end()) refuse({"a grid of angles has the value ", double{*bad}, ", expected finite numbers"});
}

/// Gives nodes below the horizon the value of the node before them in their row.
inline void continue_below_horizon(angle_grid& grid) {
  const Eigen::Index columns = std::ssize(grid.viewer_polar);
  for (Eigen::Index node = 0; node < grid.size(); ++node) {
    if (node % columns == 0 || directions_of(grid, node).wo.z() > 1e-6) continue;
    std::copy_n(grid.values.begin() + 3 * (node - 1), 3, grid.values.begin() + 3 * node);
  }
}

}  // namespace gonio::model::detail

namespace gonio::model {

GONIO_INLINE direction_pair directions_of(const angle_grid& grid, Eigen::Index node) noexcept {
  const Eigen::Index columns = std::ssize(grid.viewer_polar), rows = std::ssize(grid.viewer_azimuth),
                     angles = std::ssize(grid.theta_i);
  const double polar = grid.viewer_polar[node % columns], azimuth = grid.viewer_azimuth[node / columns % rows];
  const double theta = grid.theta_i[node / columns / rows % angles], phi = grid.phi_i[node / columns / rows / angles];
  const direction wi = spherical_direction(theta, phi);
  if (grid.viewer == viewer_angles::about_specular)
    return {wi, detail::direction_about_specular(theta, phi, polar, azimuth)};
  return {wi, spherical_direction(polar, azimuth)};
}

struct angle_grid_brdf::stored {
  explicit stored(angle_grid given)
      : grid(std::move(given)),
        phi_i(grid.phi_i, detail::angle_axis::kind::full_turn),
        theta_i(grid.theta_i, polar_kind(grid.beyond)),
        azimuth(grid.viewer_azimuth, detail::kind_of_azimuths(grid.viewer_azimuth)),
        polar(grid.viewer_polar, polar_kind(grid.beyond)) {}

  [[nodiscard]] static detail::angle_axis::kind polar_kind(beyond_grid beyond) {
    return beyond == beyond_grid::extrapolated ? detail::angle_axis::kind::extrapolated
                                               : detail::angle_axis::kind::clamped;
  }

  angle_grid grid;
  detail::angle_axis phi_i, theta_i, azimuth, polar;
};

GONIO_INLINE angle_grid_brdf::angle_grid_brdf(angle_grid grid) {
  detail::require_grid(grid);
  if (grid.viewer == viewer_angles::about_specular) detail::continue_below_horizon(grid);
  stored_ = std::make_shared<const stored>(std::move(grid));
}

GONIO_INLINE const angle_grid& angle_grid_brdf::grid() const noexcept { return stored_->grid; }

GONIO_INLINE rgb angle_grid_brdf::as_measured(const direction& wi, const direction& wo) const noexcept {
  if (!(wi.z() > 0.0 && wo.z() > 0.0)) return rgb::Zero();
  const stored& of = *stored_;
  const double theta = polar_angle(wi), phi = azimuth(wi);
  const bool is_about_specular = of.grid.viewer == viewer_angles::about_specular;
  auto [polar, around] =
      is_about_specular ? detail::angles_about_specular(theta, phi, wo) : std::pair(polar_angle(wo), azimuth(wo));
  if (!is_about_specular && !is_anisotropic()) around -= phi - of.grid.phi_i.front();
  const std::array at{of.phi_i.find(phi), of.theta_i.find(theta), of.azimuth.find(around), of.polar.find(polar)};
  const std::array<Eigen::Index, 4> sizes{std::ssize(of.grid.phi_i), std::ssize(of.grid.theta_i),
                                          std::ssize(of.grid.viewer_azimuth), std::ssize(of.grid.viewer_polar)};
  rgb sum = rgb::Zero();
  for (unsigned corner = 0; corner < 16; ++corner) {
    double weight = 1.0;
    Eigen::Index node = 0;
    for (unsigned axis = 0; axis < 4; ++axis) {
      const bool is_second = (corner >> axis & 1U) != 0;
      weight *= is_second ? at[axis].weight_of_second : at[axis].weight_of_first;
      node = node * sizes[axis] + (is_second ? at[axis].second : at[axis].first);
    }
    if (weight == 0.0) continue;
    const float* value = of.grid.values.data() + 3 * node;
    sum += weight * rgb(value[0], value[1], value[2]);
  }
  return sum;
}

}  // namespace gonio::model
