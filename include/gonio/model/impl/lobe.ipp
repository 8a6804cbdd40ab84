#pragma once
/// Bodies of model/lobe.hpp.

#include <gonio/core/brdf.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/model/lobe.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

namespace gonio::model {

GONIO_INLINE void require_within_bounds(std::string_view shape, const shape_parameter& parameter, double value) {
  if (value >= parameter.lowest && value <= parameter.highest) return;
  refuse(std::string(shape) + ": " + std::string(parameter.name) + " must be from " + std::to_string(parameter.lowest) +
         " to " + std::to_string(parameter.highest) + ", not " + std::to_string(value));
}

GONIO_INLINE void require_usable_colour(std::string_view shape, const rgb& colour) {
  if ((colour >= 0.0).all() && colour.isFinite().all()) return;
  refuse(std::string(shape) + ": the colour must be finite and not negative");
}

}  // namespace gonio::model
