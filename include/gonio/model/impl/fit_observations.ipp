#pragma once
/// Bodies of model/fit_observations.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/model/fit_observations.hpp>
#include <gonio/model/lobe.hpp>
#include <gonio/table/brdf_table.hpp>
#include <gonio/table/sample_set.hpp>

#include <cstddef>
#include <vector>

namespace gonio {

GONIO_INLINE std::vector<fit_observation> fit_observations(const brdf_table& table, thread_count threads) {
  const direction normal(0.0, 0.0, 1.0);
  std::vector<fit_observation> all(table.cells().size(), {lobe_geometry(normal, normal), rgb::Zero(), 1.0});
  for_each_block(
      all.size(), 4096,
      [&](block range) {
        for (std::size_t cell = range.begin; cell < range.end; ++cell) {
          const auto [wi, wo] = to_directions(table.cells().angles(cell));
          all[cell] = {lobe_geometry(wi, wo), table.at(cell), 1.0};
        }
      },
      threads);
  return all;
}

}  // namespace gonio
