#include "model_choice.hpp"

#include "tool/files/json.hpp"
#include "tool/pages/measures_as_json.hpp"
#include <gonio/metric/log.hpp>
#include <gonio/metric/root.hpp>

#include <algorithm>

namespace cli {

std::vector<const gonio::model::lobe_kind*> lobes_named(const std::string& model) {
  constexpr std::string_view prefix = "sum:";
  if (!model.starts_with(prefix)) {
    const gonio::model::lobe_kind& kind = gonio::model::lobe_kind_named(model);
    const auto& lambert = gonio::model::lobe_kind::of<gonio::model::lambert_shape>();
    if (kind == lambert) return {&lambert};
    return {&lambert, &kind};
  }
  std::vector<const gonio::model::lobe_kind*> kinds;
  for (std::size_t begin = prefix.size(); begin <= model.size();) {
    const std::size_t end = std::min(model.find('+', begin), model.size());
    kinds.push_back(&gonio::model::lobe_kind_named(model.substr(begin, end - begin)));
    begin = end + 1;
  }
  return kinds;
}

bool is_anisotropic(const model_choice& choice) {
  return std::ranges::any_of(lobes_named(choice.model),
                             [](const gonio::model::lobe_kind* kind) { return kind->is_anisotropic(); });
}

const gonio::model::lobe_kind& with_fresnel_factor(const gonio::model::lobe_kind& kind) {
  const std::string name = std::string(kind.name()) + "-fresnel";
  for (const gonio::model::lobe_kind* other : gonio::model::lobe_kinds())
    if (other->name() == name) return *other;
  gonio::refuse(std::string(kind.name()) +
                ": --fresnel needs phong, blinn-phong or phong-blinn (microfacet models contain the factor)");
}

void add_fit_options(command& to, gonio::model::model_fit_options& options) {
  to.add_choice(
        "--loss", [&options](int norm) { options.norm = static_cast<gonio::model::fit_norm>(norm); },
        {{"l1", static_cast<int>(gonio::model::fit_norm::l1)},
         {"l2", static_cast<int>(gonio::model::fit_norm::l2)},
         {"huber", static_cast<int>(gonio::model::fit_norm::huber)}},
        "Loss of the residuals: l1 (favours the base of highlights), l2 (their peaks), huber (both)")
      .default_str(options.norm == gonio::model::fit_norm::huber ? "huber" : "l2");
  to.add_flag("--cosine-weighted", options.cosine_weighted,
              "Compare reflectance times the cosine of the light's angle (the default)");
  to.add_option("--largest-albedo", options.largest_albedo,
                "Largest albedo of the model, for light up to 88 degrees from the normal: 1 is all light; a large "
                "number sets no limit")
      .check(check::positive_number())
      .capture_default_str();
  to.add_option("--starts", options.random_starts, "Number of random starts, in addition to the consecutive scheme")
      .check(check::range(0, 10'000))
      .capture_default_str();
  to.add_option("--seed", options.seed, "Seed of the random starts").capture_default_str();
}

void add_cell_weights_option(command& to, gonio::model::cell_weighting& weighting) {
  to.add_choice(
        "--cell-weights", [&weighting](int chosen) { weighting = static_cast<gonio::model::cell_weighting>(chosen); },
        {{"equal", static_cast<int>(gonio::model::cell_weighting::equal)},
         {"solid-angle", static_cast<int>(gonio::model::cell_weighting::solid_angle)},
         {"cosine", static_cast<int>(gonio::model::cell_weighting::cosine)}},
        "Weight of a table's cells: equal, their solid angle, or solid angle times both cosines")
      .default_str("equal");
}

gonio::model::model_fit fit_by_metric(const std::string& metric,
                                      const std::vector<const gonio::model::lobe_kind*>& kinds,
                                      std::span<const gonio::model::fit_observation> observations,
                                      const gonio::model::model_fit_options& options) {
  if (metric == "log") return gonio::model::fit_model(kinds, observations, gonio::log(), options);
  if (metric == "cubic") return gonio::model::fit_model(kinds, observations, gonio::root(3.0), options);
  return gonio::model::fit_model(kinds, observations, gonio::lin(), options);
}

gonio::model::model_fit fit_chosen(const model_choice& choice,
                                   std::span<const gonio::model::fit_observation> observations) {
  auto kinds = lobes_named(choice.model);
  if (choice.fresnel) kinds.back() = &with_fresnel_factor(*kinds.back());
  return fit_by_metric(choice.metric, kinds, observations, choice.fit);
}

json to_json(const gonio::model::analytic_brdf& model) {
  json lobes = json::array();
  for (const gonio::model::analytic_lobe& lobe : model.lobes()) {
    json parameters = json::object();
    const auto about = lobe.kind().parameters();
    for (std::size_t i = 0; i < about.size(); ++i) parameters[std::string(about[i].name)] = lobe.parameters()[i];
    lobes.push_back({{"lobe", lobe.kind().name()}, {"colour", per_channel(lobe.colour())}, {"parameters", parameters}});
  }
  return lobes;
}

}  // namespace cli
