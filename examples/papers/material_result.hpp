#pragma once
/// The error of a reconstructed material, shared by the published experiments.

#include <gonio/evaluate/comparison.hpp>

#include <span>
#include <string>

namespace papers {

struct material_result {
  std::string name;
  gonio::comparison errors;
};

/// Returns the mean of a measure over materials. A measure with a value per channel must itself average the channels.
template <class Measure>
[[nodiscard]] double mean_over(std::span<const material_result> results, Measure&& measure) {
  double sum = 0.0;
  for (const material_result& result : results) sum += measure(result.errors);
  return sum / static_cast<double>(results.size());
}

}  // namespace papers
