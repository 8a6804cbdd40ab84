#pragma once
/// Bodies of evaluate/simulated_measurement.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/random.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/table/brdf_table.hpp>
#include <gonio/table/sample_set.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <span>
#include <vector>

namespace gonio {

GONIO_INLINE sample_set sample_table_misplaced(const brdf_table& table, std::span<const direction_pair> pairs,
                                               double angle, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  sample_set samples;
  for (const auto& [wi, wo] : pairs) {
    const direction light = misplaced(wi, angle, generator), viewer = misplaced(wo, angle, generator);
    samples.push_back({direction_pair{wi, wo}, table(light, viewer), 1.0});
  }
  return samples;
}

GONIO_INLINE std::vector<Eigen::Index> random_cells(const valid_cells& cells, Eigen::Index count, std::uint64_t seed) {
  if (count < 1 || count > cells.size())
    refuse("cannot choose " + std::to_string(count) + " different cells of " + std::to_string(cells.size()));
  return random_choice(cells.size(), count, seed);
}

GONIO_INLINE std::vector<Eigen::Index> cells_at(const valid_cells& cells, std::span<const half_difference> directions) {
  std::vector<Eigen::Index> chosen;
  for (const half_difference& angles : directions) {
    const Eigen::Index linear = cells.grid().linear(cells.grid().nearest(angles));
    if (!cells.contains(linear))
      refuse("direction " + std::to_string(chosen.size() + 1) + " (theta_h " + std::to_string(degrees(angles.theta_h)) +
             ", theta_d " + std::to_string(degrees(angles.theta_d)) + ", phi_d " +
             std::to_string(degrees(angles.phi_d)) + " degrees) is below the horizon or not in the table");
    chosen.push_back(cells.representative(linear));
  }
  return chosen;
}

GONIO_INLINE sample_set sample_table(const brdf_table& table, std::span<const Eigen::Index> cells,
                                     const measurement_defects& defects, std::uint64_t seed) {
  sample_set samples;
  samples.reserve(cells.size());
  for (const Eigen::Index cell : cells) {
    const half_difference angles = table.cells().angles(cell);
    const rgb value = defects.aperture.is_point() ? rgb(table.at(cell))
                                                  : mean_within(to_directions(angles), defects.aperture,
                                                                measurement_defects::pairs_a_reading, table);
    samples.push_back({angles, value, 1.0, defects.aperture});
  }
  std::uniform_int_distribution<Eigen::Index> any_cell(0, table.cells().size() - 1);
  return corrupt(std::move(samples), defects, seed,
                 [&](std::mt19937_64& generator) { return rgb(table.at(any_cell(generator))); });
}

GONIO_INLINE std::vector<direction_pair> random_pairs(const valid_cells& cells, Eigen::Index count,
                                                      std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> any_azimuth(0.0, 2.0 * std::numbers::pi);
  std::vector<direction_pair> pairs;
  for (const Eigen::Index cell : random_cells(cells, count, seed)) {
    const direction_pair pair = to_directions(cells.angles(cell));
    const double turn = any_azimuth(generator);
    pairs.push_back({turned_about_normal(pair.wi, turn), turned_about_normal(pair.wo, turn)});
  }
  return pairs;
}

GONIO_INLINE sample_split split_samples(const sample_set& samples, Eigen::Index count, std::uint64_t seed) {
  if (count < 0 || count > std::ssize(samples))
    refuse("cannot choose " + std::to_string(count) + " of " + std::to_string(samples.size()) + " samples");
  std::vector<bool> chosen(samples.size());
  for (const Eigen::Index i : random_choice(samples.size(), count, seed)) chosen[i] = true;
  sample_split parts;
  for (Eigen::Index i = 0; i < std::ssize(samples); ++i) (chosen[i] ? parts.some : parts.others).push_back(samples[i]);
  return parts;
}

}  // namespace gonio
