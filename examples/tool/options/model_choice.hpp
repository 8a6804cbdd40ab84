#pragma once
/// Analytic models as options, and their printed form.

#include "command.hpp"
#include "tool/files/json.hpp"
#include "tool/pages/measures_as_json.hpp"
#include <gonio/model/fit_model.hpp>

#include <span>
#include <string>
#include <vector>

namespace cli {

/// A model, and how it is fitted. The defaults come nearest to measured materials (docs/results/models.md).
struct model_choice {
  std::string model = "ggx", metric = "log";
  bool fresnel = false;
  gonio::model::model_fit_options fit{
      .norm = gonio::model::fit_norm::huber, .cosine_weighted = true, .largest_albedo = 1.0};
};

/// Returns the lobes of a model: of `ggx`, a Lambertian lobe and ggx; of `sum:ggx+ward`, only the named ones. Throws
/// gonio::error for an unknown name.
[[nodiscard]] std::vector<const gonio::model::lobe_kind*> lobes_named(const std::string& model);

/// Is one of the lobes of a model anisotropic? Throws gonio::error as `lobes_named` does.
[[nodiscard]] bool is_anisotropic(const model_choice& choice);

/// Returns the kind with Fresnel's factor: phong-fresnel for phong. Throws gonio::error for a kind that has none.
[[nodiscard]] const gonio::model::lobe_kind& with_fresnel_factor(const gonio::model::lobe_kind& kind);

/// Adds `--loss`, `--cosine-weighted`, `--largest-albedo`, `--starts` and `--seed`.
void add_fit_options(command& to, gonio::model::model_fit_options& options);

/// Adds `--cell-weights`.
void add_cell_weights_option(command& to, gonio::model::cell_weighting& weighting);

/// Fits with one of the metrics lin, log and cubic.
[[nodiscard]] gonio::model::model_fit fit_by_metric(const std::string& metric,
                                                    const std::vector<const gonio::model::lobe_kind*>& kinds,
                                                    std::span<const gonio::model::fit_observation> observations,
                                                    const gonio::model::model_fit_options& options);

/// Fits the chosen model. Throws gonio::error as `lobes_named` and `with_fresnel_factor` do.
[[nodiscard]] gonio::model::model_fit fit_chosen(const model_choice& choice,
                                                 std::span<const gonio::model::fit_observation> observations);

/// Returns the lobes with their colours and parameters.
[[nodiscard]] json to_json(const gonio::model::analytic_brdf& model);

}  // namespace cli
