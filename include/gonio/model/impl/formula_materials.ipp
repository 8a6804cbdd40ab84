#pragma once
/// Bodies of model/formula_materials.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/model/formula_materials.hpp>
#include <gonio/model/ggx.hpp>
#include <gonio/model/lambert.hpp>
#include <gonio/model/sum_of_lobes.hpp>

#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace gonio::model::detail {

GONIO_INLINE std::vector<std::pair<std::string, formula_brdf>> formula_library() {
  const auto diffuse_and_gloss = [](const rgb& albedo, double alpha, double f0) {
    return formula_brdf(sum_of_lobes{lambertian{albedo}, ggx{.alpha = alpha, .f0 = rgb::Constant(f0)}});
  };
  return {{"red-paint", diffuse_and_gloss({0.42, 0.028, 0.022}, 0.15, 0.04)},
          {"blue-rubber", diffuse_and_gloss({0.03, 0.07, 0.28}, 0.5, 0.03)},
          {"gold-metal", formula_brdf(ggx{.alpha = 0.3, .f0 = {1.0, 0.77, 0.34}})},
          {"grey-lambertian", formula_brdf(lambertian{rgb::Constant(0.18)})}};
}

}  // namespace gonio::model::detail

namespace gonio::model {

GONIO_INLINE std::vector<std::string> formula_material_names() {
  std::vector<std::string> names;
  for (const auto& [name, material] : detail::formula_library()) names.push_back(name);
  return names;
}

GONIO_INLINE formula_brdf formula_material(std::string_view name) {
  std::string known;
  for (const auto& [candidate, material] : detail::formula_library()) {
    if (candidate == name) return material;
    known += (known.empty() ? "" : ", ") + candidate;
  }
  refuse("there is no formula material named '" + std::string(name) + "'; the names are " + known);
}

}  // namespace gonio::model
