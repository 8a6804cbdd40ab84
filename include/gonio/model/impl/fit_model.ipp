#pragma once
/// Bodies of model/fit_model.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/model/fit_model.hpp>
#include <gonio/model/model_loss.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio::detail {

GONIO_INLINE std::vector<lobe_kind::values> typical_shapes(const std::vector<const lobe_kind*>& kinds) {
  std::vector<lobe_kind::values> shapes;
  for (std::size_t l = 0; l < kinds.size(); ++l) {
    const auto before = std::count(kinds.begin(), kinds.begin() + static_cast<std::ptrdiff_t>(l), kinds[l]);
    lobe_kind::values start = kinds[l]->typical();
    const auto about = kinds[l]->parameters();
    for (std::size_t p = 0; p < about.size() && before > 0; ++p) {
      const double way = (before % 2 == 1 ? 1.0 : -1.0) * static_cast<double>((before + 1) / 2);
      const double moved = about[p].logarithmic ? start[p] * std::exp2(2.0 * way)
                                                : start[p] + 0.2 * way * (about[p].highest - about[p].lowest);
      start[p] = std::clamp(moved, about[p].lowest, about[p].highest);
    }
    shapes.push_back(start);
  }
  return shapes;
}

}  // namespace gonio::detail
