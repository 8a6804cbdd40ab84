#pragma once
/// Bodies of evaluate/appearance_metric.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/evaluate/appearance_metric.hpp>
#include <gonio/evaluate/sphere_delta_e.hpp>

namespace gonio {

GONIO_INLINE appearance_metric::appearance_metric(const valid_cells& cells, int size, thread_count threads)
    : lights_(cells, render::two_lights(), size, sphere_delta_e::middle_grey, threads),
      environment_(cells, render::environment_lighting(), size, sphere_delta_e::middle_grey, threads) {}

GONIO_INLINE appearance appearance_metric::look(const brdf_table& table, thread_count threads) const {
  constexpr double exposure = 1.0;
  return {lights_.look(table, exposure, threads), environment_.look(table, exposure, threads)};
}

}  // namespace gonio
