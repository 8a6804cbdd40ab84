#pragma once
/// Bodies of table/image_samples.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/table/image_samples.hpp>
#include <gonio/table/sample_set.hpp>

#include <vector>

namespace gonio {

GONIO_INLINE sample_set as_sample_set(const image_samples& picture) {
  sample_set samples;
  samples.reserve(picture.size());
  for (const pair_sample& s : picture)
    samples.push_back({to_half_difference(s.directions.wi, s.directions.wo), s.value, s.weight});
  return samples;
}

}  // namespace gonio
