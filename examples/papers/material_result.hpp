#pragma once
/// What the published experiments share: how each material came out.

#include <gonio/evaluate/comparison.hpp>

#include <span>
#include <string>

namespace papers {

/// How one material came out.
struct material_result {
  std::string name;
  gonio::comparison errors;
};

/// The mean over materials, and over channels where there is one value a channel, of a measure.
template <class Measure>
[[nodiscard]] double mean_over(std::span<const material_result> results, Measure&& measure) {
  double sum = 0.0;
  for (const material_result& result : results) sum += measure(result.errors);
  return sum / static_cast<double>(results.size());
}

}  // namespace papers
