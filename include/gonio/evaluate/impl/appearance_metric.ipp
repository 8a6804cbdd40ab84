#pragma once
/// Bodies of evaluate/appearance_metric.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/evaluate/appearance_metric.hpp>
#include <gonio/evaluate/sphere_delta_e.hpp>

namespace gonio {

GONIO_INLINE appearance appearance_metric::look(const brdf_table& table, thread_count threads) const {
  constexpr double exposure = 1.0;
  return {lights_.look(table, exposure, threads), environment_.look(table, exposure, threads)};
}

}  // namespace gonio
