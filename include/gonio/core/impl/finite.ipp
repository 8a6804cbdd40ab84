#pragma once
/// Bodies of core/finite.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/finite.hpp>

#include <cmath>
#include <span>

namespace gonio {

GONIO_INLINE bool all_finite(std::span<const double> values) noexcept {
  for (const double value : values)
    if (!std::isfinite(value)) return false;
  return true;
}

GONIO_INLINE bool all_finite(std::span<const float> values) noexcept {
  for (const float value : values)
    if (!std::isfinite(value)) return false;
  return true;
}

}  // namespace gonio
