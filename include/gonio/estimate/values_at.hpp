#pragma once
/// Evaluates an estimate at many locations.

#include <gonio/estimate/estimator.hpp>
#include <gonio/estimate/located_samples.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <iterator>
#include <optional>
#include <vector>

namespace gonio {

/// Evaluates an estimate at n locations on `cells`: 3 x n. If the estimate is over the same cells, calls its `at`.
/// Otherwise evaluates it in the directions of each location. If more than 4,096 locations are cells, first tabulates
/// the estimate and reads these locations from the table.
template <tabulated_brdf Fit>
[[nodiscard]] channel_values values_at(const Fit& fit, const valid_cells& cells, const std::vector<location>& locations,
                                       thread_count threads = {}) {
  const auto collect = [&](auto&& value_at) {
    channel_values values(3, std::ssize(locations));
    for_each_index(
        locations.size(), 256, [&](Eigen::Index i) { values.col(i) = value_at(locations[i]).template cast<float>(); },
        threads);
    return values;
  };
  if constexpr (requires { fit.at(locations[0]); })
    if (fit.cells() == cells) return collect([&](const location& at) { return fit.at(at); });
  // A table costs as much as several thousand evaluations.
  constexpr std::ptrdiff_t worth_a_table = 4096;
  std::optional<brdf_table> table;
  if (std::ranges::count_if(locations, [](const location& at) { return at.count == 1; }) > worth_a_table)
    table = fit.tabulate(cells, threads);
  return collect([&](const location& at) {
    if (table && at.count == 1) return rgb(table->at(Eigen::Index{at.cell[0]}));
    const auto [wi, wo] = to_directions(at.angles);
    return rgb(fit(wi, wo));
  });
}

}  // namespace gonio
