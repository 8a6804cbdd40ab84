#pragma once
/// Measurements as the fit of an analytic model reads them.

#include <gonio/core/parallel.hpp>
#include <gonio/model/lobe.hpp>
#include <gonio/table/brdf_table.hpp>
#include <gonio/table/sample_set.hpp>

#include <cstddef>
#include <vector>

namespace gonio {

/// One measurement of all three channels.
struct fit_observation {
  lobe_geometry at;
  rgb value;
  channel_weights weight;
};

/// Samples. Throws gonio::error for those that cannot be used (`require_usable`).
template <sample_range Samples>
[[nodiscard]] std::vector<fit_observation> fit_observations(const Samples& samples) {
  require_usable(samples);
  std::vector<fit_observation> all;
  for (const sample& s : samples) {
    const auto [wi, wo] = to_directions(s.angles);
    all.push_back({lobe_geometry(wi, wo), s.value, s.weight});
  }
  return all;
}

/// All cells of a table, each of which counts once. 104 bytes a cell.
[[nodiscard]] std::vector<fit_observation> fit_observations(const brdf_table& table, thread_count threads = {});

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/model/impl/fit_observations.ipp>
#endif
