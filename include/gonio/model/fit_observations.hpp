#pragma once
/// Measurements as input of the fit of an analytic model.

#include <gonio/core/parallel.hpp>
#include <gonio/model/lobe.hpp>
#include <gonio/table/brdf_table.hpp>
#include <gonio/table/grid.hpp>
#include <gonio/table/sample_set.hpp>

#include <cstddef>
#include <vector>

namespace gonio::model {

/// One measurement of all three channels.
struct fit_observation {
  lobe_geometry at;
  rgb value;
  channel_weights weight;
};

/// Converts samples. Throws gonio::error for unusable samples (`require_usable`).
template <sample_range Samples>
[[nodiscard]] std::vector<fit_observation> fit_observations(const Samples& samples) {
  require_usable(samples);
  std::vector<fit_observation> all;
  for (const sample& s : samples) {
    const auto [wi, wo] = s.directions.pair();
    all.push_back({lobe_geometry(wi, wo), s.value, s.weight});
  }
  return all;
}

/// The weight of each cell of a table in a fit. The cells of MERL's grid are narrow at the highlight: half of the cells
/// (63 % of the valid cells) have a theta_h below 22.5 degrees, but only a seventh of all pairs of directions has.
enum class cell_weighting {
  equal,        ///< 1
  solid_angle,  ///< the solid angle dwi dwo = 4 cos(theta_d) dwh dwd of the cell
  cosine        ///< the solid angle times cos(theta_i) cos(theta_o): the light that the cell transfers under uniform
                ///< illumination
};

/// Returns all cells of a table, with weights whose mean is 1. 136 bytes per cell.
[[nodiscard]] std::vector<fit_observation> fit_observations(const brdf_table& table, thread_count threads = {},
                                                            cell_weighting weighting = cell_weighting::equal);

namespace detail {

/// Returns the solid angle in sr^2 of the pairs of directions nearest to the node of a cell, for each radian of the
/// half vector's azimuth: the integral of 4 cos(theta_d) sin(theta_h) sin(theta_d) over theta_h, theta_d and phi_d.
[[nodiscard]] double solid_angle_of_pairs(const grid& of, const cell_index& cell);

}  // namespace detail

}  // namespace gonio::model

#if !defined(GONIO_COMPILED)
#include <gonio/model/impl/fit_observations.ipp>
#endif
