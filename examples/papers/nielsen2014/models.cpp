/// gonio-papers models: Nielsen, Frisvad, Conradsen and Aanaes 2014, "Addressing Grazing Angle Reflections in Phong
/// Models", on surrogates of the materials that they fit.

#include "papers/distribution.hpp"
#include "papers/experiments.hpp"
#include "papers/networks_option.hpp"
#include "papers/resumable_results.hpp"
#include "tool/files/json.hpp"
#include "tool/options/chosen_networks.hpp"
#include "tool/options/model_choice.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/measures_as_json.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/evaluate/appearance_metric.hpp>
#include <gonio/io/materials/networks.hpp>

#include <iomanip>
#include <iostream>
#include <map>
#include <memory>
#include <sstream>

namespace papers {

namespace {

struct models_options : resumable_options {
  std::filesystem::path networks;
  std::vector<std::string> models{"phong", "blinn-phong", "phong-blinn", "phong-blinn-fresnel"}, losses{"l1", "l2"},
      last_stages{"all"}, only;
  std::string metric = "lin";
  gonio::model::cell_weighting cell_weights = gonio::model::cell_weighting::equal;
  bool print_json = false;
};

/// Returns a number with four significant digits.
std::string significant(double value) {
  std::ostringstream text;
  text << std::setprecision(4) << value;
  return text.str();
}

/// Returns cells with every third theta_d and fifth phi_d. Lobes are smooth there, and a fit takes a fifteenth of the
/// time.
gonio::valid_cells cells_of_fit() { return gonio::valid_cells(gonio::grid({90, 30, 36})); }

json fit_one(const models_options& given, const std::string& model, const std::string& loss,
             const std::string& last_stage, std::span<const gonio::model::fit_observation> observations,
             const gonio::brdf_table& truth, const gonio::appearance_metric& appearance) {
  const gonio::model::model_fit fit =
      fit_by_metric(given.metric, lobes_named(model), observations,
                    {.norm = loss == "l1" ? gonio::model::fit_norm::l1 : gonio::model::fit_norm::l2,
                     .diffuse_stays = last_stage == "printed",
                     .threads = given.threads});
  const auto seen =
      appearance.difference(gonio::tabulate(fit.model, truth.cells(), given.threads), truth, given.threads);
  return {{"converged", fit.converged},    {"evaluations", fit.evaluations}, {"loss", fit.loss},
          {"promised", fit.promised_gain}, {"delta_e_lights", seen.lights},  {"delta_e_env", seen.environment},
          {"lobes", to_json(fit.model)}};
}

/// Returns all fits in the order of the materials.
json fit_all(const models_options& given, progress_bar& bar) {
  const auto all = gonio::io::read_networks(given.networks);
  const auto networks = given.only.empty() ? all : networks_in(all, given.only, given.networks);
  const gonio::valid_cells cells = cells_of_fit();
  const gonio::material_set materials = gonio::model::tabulate_networks(networks, cells, given.threads);
  const gonio::appearance_metric appearance(cells, 36, given.threads);
  resumable_results results(given);
  json rows = json::array();
  for (std::size_t m = 0; m < materials.names.size(); ++m) {
    gonio::report(bar.listener(), materials.names[m],
                  static_cast<double>(m) / static_cast<double>(materials.names.size()));
    const gonio::brdf_table truth = materials.table(m);
    const auto observations = gonio::model::fit_observations(truth, given.threads, given.cell_weights);
    for (const std::string& model : given.models)
      for (const std::string& loss : given.losses)
        for (const std::string& last_stage : given.last_stages) {
          const json key{materials.names[m], model, loss, given.metric, static_cast<int>(given.cell_weights),
                         last_stage};
          const json& fit = results.once(
              key, m, [&] { return fit_one(given, model, loss, last_stage, observations, truth, appearance); });
          rows.push_back({{"material", materials.names[m]},
                          {"model", model},
                          {"loss", loss},
                          {"last_stage", last_stage},
                          {"fit", fit}});
        }
  }
  return rows;
}

std::vector<json> of(const std::vector<json>& rows, const std::string& key, const std::string& value) {
  std::vector<json> some;
  for (const json& row : rows)
    if (row[key] == value) some.push_back(row);
  return some;
}

/// Prints the means of one model and one loss.
void print_mean(const std::vector<json>& rows) {
  std::vector<double> lights, environment, evaluations, losses;
  std::size_t converged = 0;
  for (const json& row : rows) {
    const json& fit = row["fit"];
    lights.push_back(fit["delta_e_lights"].number());
    environment.push_back(fit["delta_e_env"].number());
    evaluations.push_back(fit["evaluations"].number());
    losses.push_back(fit["loss"].number());
    if (fit["converged"].truth()) ++converged;
  }
  const distribution l(lights), e(environment), least(losses);
  std::cout << " | " << lights.size() << " | " << converged << " | " << fixed(distribution(evaluations).mean, 0)
            << " | " << significant(least.mean) << " | " << significant(least.median);
  for (const double value : {l.mean, l.median, l.worst, e.mean, e.median, e.worst})
    std::cout << " | " << fixed(value, 2);
  std::cout << " |\n";
}

void print_means(const models_options& given, const json& rows) {
  const bool compares = given.last_stages.size() > 1;
  std::cout
      << "| model | loss | " << (compares ? "last stage | " : "")
      << "fits | converged | evaluations, mean | its value: mean | median | Delta E lights: mean | median | worst "
         "| Delta E env: mean | median | worst |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|"
      << (compares ? "---|\n" : "\n");
  for (const std::string& model : given.models)
    for (const std::string& loss : given.losses)
      for (const std::string& last_stage : given.last_stages) {
        std::cout << "| " << model << " | " << loss << (compares ? " | " + last_stage : "");
        print_mean(of(of(of(rows.elements(), "model", model), "loss", loss), "last_stage", last_stage));
      }
}

/// Prints for each material the variants' alpha, and each model's loss and Delta E.
void print_materials(const models_options& given, const json& rows) {
  std::cout << "\n| material | loss | alpha | alpha with Fresnel |";
  for (const std::string& model : given.models) std::cout << ' ' << model << ": loss | Delta E lights |";
  std::cout << "\n|---|---|---|---|";
  for (std::size_t i = 0; i < given.models.size(); ++i) std::cout << "---|---|";
  std::cout << '\n';
  std::map<std::pair<std::string, std::string>, std::map<std::string, json>> by_material;
  for (const json& row : rows.elements())
    by_material[{row["material"].text(), row["loss"].text()}][row["model"].text()] = row["fit"];
  for (const auto& [key, fits] : by_material) {
    std::cout << "| " << key.first << " | " << key.second;
    for (const char* variant : {"phong-blinn", "phong-blinn-fresnel"}) {
      std::cout << " | ";
      if (fits.contains(variant))
        std::cout << fixed(fits.at(variant)["lobes"].elements().back()["parameters"]["alpha"].number(), 2);
    }
    for (const std::string& model : given.models)
      std::cout << " | " << significant(fits.at(model)["loss"].number()) << " | "
                << fixed(fits.at(model)["delta_e_lights"].number(), 2);
    std::cout << " |\n";
  }
}

void run(const models_options& given) {
  progress_bar bar;
  const json rows = fit_all(given, bar);
  if (!given.prints()) return;
  bar.wipe();
  if (given.print_json) {
    std::cout << rows.dump(2) << '\n';
    return;
  }
  print_means(given, rows);
  if (given.last_stages.size() == 1) print_materials(given, rows);
}

}  // namespace

void add_models(command& app, const team& processes) {
  auto command = app.add_subcommand(
      "models", "Analytic models fitted to 100 materials: which are like Phong, which like Blinn-Phong (Nielsen 2014)");
  const auto options = std::make_shared<models_options>();
  add_networks_option(command, options->networks);
  command.add_option("--models", options->models, "Models, named as in `gonio fit --model`").capture_default_str();
  command.add_option("--losses", options->losses, "l1 and l2").check(check::one_of({"l1", "l2"})).capture_default_str();
  command
      .add_option("--last-stage", options->last_stages,
                  "Parameters that the last of the three stages of a fit finds: all, or printed (all but the diffuse "
                  "colours, as in the paper)")
      .check(check::one_of({"all", "printed"}))
      .capture_default_str();
  command.add_option("--metric", options->metric, "Metric that compares reflectance: lin (as it is), log or cubic")
      .check(check::one_of({"lin", "log", "cubic"}))
      .capture_default_str();
  add_cell_weights_option(command, options->cell_weights);
  command.add_option("--materials", options->only, "Materials to fit (default: all)");
  command.add_flag("--json", options->print_json, "Print every fit as JSON");
  add_resumable_options(command, *options);
  do_together(command, processes, options, run);
}

}  // namespace papers
