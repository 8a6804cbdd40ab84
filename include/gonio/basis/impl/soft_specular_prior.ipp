#pragma once
/// Bodies of basis/soft_specular_prior.hpp.

#include <gonio/basis/learn_pca.hpp>
#include <gonio/basis/soft_specular_prior.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace gonio {

GONIO_INLINE soft_specular_prior::soft_specular_prior(log_relative_pca soft, log_relative_pca specular,
                                                      double threshold)
    : soft_(std::move(soft)), specular_(std::move(specular)), threshold_(threshold) {
  if (!std::isfinite(threshold)) refuse("the contrast threshold between soft and specular materials must be finite");
  const log_relative &first = soft_.metric(), &second = specular_.metric();
  if (soft_.cells() != specular_.cells() || first.weighting() != second.weighting() ||
      !std::ranges::equal(first.reference(), second.reference()))
    refuse("the soft and the specular prior must be over the same cells and relative to the same BRDF");
}

GONIO_INLINE soft_specular_prior soft_specular_prior::on(const valid_cells& cells) const {
  return {thin(soft_, cells), thin(specular_, cells), threshold_};
}

GONIO_INLINE soft_specular_prior soft_specular_prior::with_source(const std::string& source) const {
  return {soft_.with_source(source), specular_.with_source(source), threshold_};
}

}  // namespace gonio
