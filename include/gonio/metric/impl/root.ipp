#pragma once
/// Bodies of metric/root.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/metric/location_free.hpp>
#include <gonio/metric/root.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace gonio {

GONIO_INLINE root::root(double p) : p_(p) {
  if (!(p >= 1.0 && std::isfinite(p))) refuse({"the root of a metric must be finite and at least 1, not ", p});
}

}  // namespace gonio
