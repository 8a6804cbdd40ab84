#pragma once
/// Named materials given by formulas, for demonstrations and tests: their true values are known everywhere, and no
/// prior was learned from them.

#include <gonio/core/error.hpp>
#include <gonio/model/ggx.hpp>
#include <gonio/model/lambert.hpp>
#include <gonio/model/sum_of_lobes.hpp>
#include <gonio/table/brdf_table.hpp>

#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace gonio::model {

/// A material given by a formula: one of a few analytic models, chosen at run time.
class formula_brdf {
 public:
  using model = std::variant<lambertian, ggx, sum_of_lobes<lambertian, ggx>>;

  explicit formula_brdf(model chosen) : model_(std::move(chosen)) {}

  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept {
    return std::visit([&](const auto& f) { return f(wi, wo); }, model_);
  }

  /// The model with its parameters.
  [[nodiscard]] const model& formula() const noexcept { return model_; }

 private:
  model model_;
};

static_assert(brdf<formula_brdf>);

namespace detail {

[[nodiscard]] std::vector<std::pair<std::string, formula_brdf>> formula_library();

}  // namespace detail

/// Returns the names for `formula_material`: `red-paint` (glossy), `blue-rubber` (matte), `gold-metal` (a rough
/// conductor) and `grey-lambertian` (ideal diffuse, albedo 0.18).
[[nodiscard]] std::vector<std::string> formula_material_names();

/// Returns the material with this name. If there is none, throws gonio::error that lists the names.
[[nodiscard]] formula_brdf formula_material(std::string_view name);

}  // namespace gonio::model

#if defined(GONIO_COMPILED)
namespace gonio {
extern template brdf_table tabulate(const model::formula_brdf& f, const valid_cells& cells, thread_count threads);
}  // namespace gonio
#else
#include <gonio/model/impl/formula_materials.ipp>
#endif
