#pragma once
/// Bodies of design/image_candidates.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/core/progress.hpp>
#include <gonio/design/capture_geometry.hpp>
#include <gonio/design/compressed_rows.hpp>
#include <gonio/design/expected_error.hpp>
#include <gonio/design/image_candidates.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace gonio::design::detail {

GONIO_INLINE expected_error::rows joined(std::span<const expected_error::rows* const> parts, Eigen::Index m) {
  Eigen::Index n = 0;
  for (const auto* part : parts) n += part->size();
  expected_error::rows all(n, m);
  Eigen::Index begin = 0;
  for (const auto* part : parts) {
    const Eigen::Index count = part->size();
    all.materials().middleRows(begin, count) = part->materials();
    all.weighted().middleRows(begin, count) = part->weighted();
    all.noise.segment(begin, count) = part->noise;
    all.sample_noise_penalty.segment(begin, count) = part->sample_noise_penalty;
    begin += count;
  }
  return all;
}

}  // namespace gonio::design::detail
