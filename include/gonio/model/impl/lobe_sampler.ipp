#pragma once
/// Bodies of model/lobe_sampler.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/model/formula_materials.hpp>
#include <gonio/model/lobe_sampler.hpp>
#include <gonio/model/sampling_techniques.hpp>
#include <gonio/model/sum_of_lobes.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

namespace gonio::model::detail {

GONIO_INLINE direction_mixture mixture_of(const std::vector<weighed_lobe>& lobes) {
  by_viewer sum{};
  for (const weighed_lobe& lobe : lobes)
    for (Eigen::Index at = 0; at < std::ssize(sum); ++at) sum[at] += lobe.albedo[at];
  constexpr double least_share = 0.01;
  direction_mixture mixture;
  by_viewer black{};  // viewers of a black model draw cosine-weighted directions
  for (Eigen::Index at = 0; at < std::ssize(sum); ++at) black[at] = sum[at] > 0.0 ? 0.0 : 1.0;
  mixture.add(cosine_directions{}, black);
  for (const weighed_lobe& lobe : lobes)
    for (const sampling_technique& technique : lobe.techniques) {
      by_viewer shares{};
      for (Eigen::Index at = 0; at < std::ssize(sum); ++at)
        if (sum[at] > 0.0)
          shares[at] = technique.share * (lobe.albedo[at] / sum[at] + least_share) /
                       (1.0 + least_share * static_cast<double>(lobes.size()));
      mixture.add(technique.density, shares);
    }
  return mixture;
}

}  // namespace gonio::model::detail
