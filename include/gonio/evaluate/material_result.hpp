#pragma once
/// What the published experiments share: their test materials, and how each came out.

#include <gonio/evaluate/comparison.hpp>

#include <span>
#include <string>
#include <vector>

namespace gonio {

/// The ten materials that Nielsen et al. 2015 leave out of the prior (their Figure 2).
[[nodiscard]] inline const std::vector<std::string>& nielsen_test_materials() {
  static const std::vector<std::string> names{
      "black-soft-plastic", "blue-acrylic",          "blue-metallic-paint2",     "green-fabric",     "light-red-paint",
      "pink-jasper",        "silver-metallic-paint", "specular-violet-phenolic", "two-layer-silver", "white-fabric"};
  return names;
}

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
