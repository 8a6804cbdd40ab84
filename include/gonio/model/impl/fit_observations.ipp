#pragma once
/// Bodies of model/fit_observations.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/model/fit_observations.hpp>
#include <gonio/model/lobe.hpp>
#include <gonio/table/brdf_table.hpp>
#include <gonio/table/sample_set.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace gonio::model {

GONIO_INLINE double detail::solid_angle_of_pairs(const grid& of, const cell_index& cell) {
  constexpr double right_angle = std::numbers::pi / 2.0;
  const double first_h = of.theta_h_coordinate(0.0), last_h = of.theta_h_coordinate(right_angle),
               first_d = of.theta_d_coordinate(0.0), last_d = of.theta_d_coordinate(right_angle);
  const double h = of.theta_h(std::clamp(cell.theta_h - 0.5, first_h, last_h)),
               next_h = of.theta_h(std::clamp(cell.theta_h + 0.5, first_h, last_h)),
               d = of.theta_d(std::clamp(cell.theta_d - 0.5, first_d, last_d)),
               next_d = of.theta_d(std::clamp(cell.theta_d + 0.5, first_d, last_d));
  const double phi = std::numbers::pi / of.extents().phi_d;
  return (std::cos(h) - std::cos(next_h)) * 2.0 * (std::pow(std::sin(next_d), 2) - std::pow(std::sin(d), 2)) * phi;
}

GONIO_INLINE std::vector<fit_observation> fit_observations(const brdf_table& table, thread_count threads,
                                                           cell_weighting weighting) {
  const direction normal(0.0, 0.0, 1.0);
  const grid& of = table.cells().grid();
  const auto weight_of = [&](Eigen::Index cell, const lobe_geometry& at) {
    if (weighting == cell_weighting::equal) return 1.0;
    const double pairs = detail::solid_angle_of_pairs(of, of.cell(table.cells().linear(cell)));
    return weighting == cell_weighting::cosine ? pairs * at.cosine_i * at.cosine_o : pairs;
  };
  std::vector<fit_observation> all(table.cells().size(), {lobe_geometry(normal, normal), rgb::Zero(), 1.0});
  for_each_index(
      all.size(), 4096,
      [&](Eigen::Index cell) {
        const auto [wi, wo] = to_directions(table.cells().angles(cell));
        const lobe_geometry at(wi, wo);
        all[cell] = {at, table.at(cell), weight_of(cell, at)};
      },
      threads);
  if (weighting == cell_weighting::equal) return all;
  double sum = 0.0;
  for (const fit_observation& seen : all) sum += seen.weight.mean();
  for (fit_observation& seen : all) seen.weight = seen.weight.mean() * static_cast<double>(all.size()) / sum;
  return all;
}

}  // namespace gonio::model
