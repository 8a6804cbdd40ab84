#pragma once
/// What the published experiments share: their test materials, and how each came out.

#include <gonio/evaluate/comparison.hpp>

#include <span>
#include <string>
#include <vector>

namespace gonio {

/// The ten materials that Nielsen et al. 2015 leave out of the prior (their Figure 2).
[[nodiscard]] const std::vector<std::string>& nielsen_test_materials();

/// How one material came out.
struct material_result {
  std::string name;
  comparison errors;
};

/// The mean over materials, and over channels where there is one value a channel, of a measure.
template <class Measure>
[[nodiscard]] double mean_over(std::span<const material_result> results, Measure&& measure) {
  double sum = 0.0;
  for (const material_result& result : results) sum += measure(result.errors);
  return sum / static_cast<double>(results.size());
}

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/evaluate/impl/material_result.ipp>
#endif
