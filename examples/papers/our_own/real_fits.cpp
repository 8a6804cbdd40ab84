/// gonio-papers real-fits: analytic models fitted to measured materials, with every error measure.

#include "papers/distribution.hpp"
#include "papers/experiments.hpp"
#include "papers/our_own/left_out_families.hpp"
#include "papers/resumable_results.hpp"
#include "tool/files/json.hpp"
#include "tool/options/model_choice.hpp"
#include "tool/options/thinning.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/evaluate/appearance_metric.hpp>

#include <iostream>
#include <map>
#include <memory>

namespace papers {

namespace {

struct real_fits_options : resumable_options {
  std::filesystem::path materials;
  std::vector<std::string> models{"ggx", "torrance-sparrow", "ward-bounded", "phong-fresnel", "sum:lambert+ggx+ggx"};
  std::vector<std::string> metrics{"lin", "log", "cubic"}, losses{"l1", "l2", "huber"}, weightings{"none", "cosine"},
      cell_weights{"equal", "cosine"};
  std::vector<Eigen::Index> random{100, 2000};
  Eigen::Index repetitions = 2;
  bool tables = false;
  thinning thin{{3, 5}};
};

/// An error measure, named as in the options of gonio fit.
struct error_choice {
  std::string metric, loss;
  bool cosine_weighted = false;
  std::string cell_weights = "equal";  ///< of a table

  [[nodiscard]] gonio::model::model_fit_options options(gonio::thread_count threads) const {
    using gonio::model::fit_norm;
    return {.norm = loss == "l1"      ? fit_norm::l1
                    : loss == "huber" ? fit_norm::huber
                                      : fit_norm::l2,
            .cosine_weighted = cosine_weighted,
            .threads = threads};
  }
  [[nodiscard]] gonio::model::cell_weighting weighting() const {
    return cell_weights == "cosine" ? gonio::model::cell_weighting::cosine : gonio::model::cell_weighting::equal;
  }
  [[nodiscard]] json key() const { return {metric, loss, cosine_weighted, cell_weights}; }
};

/// Returns all error measures of samples, or of tables.
std::vector<error_choice> choices(const real_fits_options& given, bool of_tables) {
  std::vector<error_choice> all;
  for (const std::string& metric : given.metrics)
    for (const std::string& weighting : given.weightings)
      for (const std::string& loss : given.losses)
        for (const std::string& cells : of_tables ? given.cell_weights : std::vector<std::string>{"equal"})
          all.push_back({metric, loss, weighting == "cosine", cells});
  return all;
}

class fits_experiment {
 public:
  fits_experiment(const real_fits_options& given, progress_bar& bar)
      : given_(given),
        bar_(bar),
        library_({}, given.materials, given.thin, bar.listener(), given.threads),
        judge_(library_.cells(), 36, given.threads),
        results_(given) {}

  /// Returns a row for each error measure, model and number of samples (0: a table), with the distribution of Delta E.
  [[nodiscard]] json run() {
    const std::vector<judged_material> materials = measured_materials(given_.materials, library_);
    json rows = json::array();
    if (given_.tables) add_rows(materials, 0, rows);
    for (const Eigen::Index count : given_.random)
      if (!given_.tables) add_rows(materials, count, rows);
    return rows;
  }

 private:
  void add_rows(const std::vector<judged_material>& materials, Eigen::Index count, json& rows) {
    for (const error_choice& choice : choices(given_, count == 0))
      for (const std::string& model : given_.models) {
        std::vector<double> errors;
        for (const judged_material& material : materials) {
          const json key{choice.key(), model, count, material.name, given_.repetitions};
          const json& error = results_.once(key, material.turn, [&]() -> json {
            bar_.draw(material.name + " " + model, 0.0);
            return error_of(material, count, choice, model);
          });
          if (!error.is_null()) errors.push_back(error.number());
        }
        if (errors.empty()) continue;  // left to other processes
        const distribution seen(errors);
        rows.push_back({{"choice", choice.key()},
                        {"model", model},
                        {"samples", count},
                        {"mean", seen.mean},
                        {"median", seen.median},
                        {"worst", seen.worst}});
      }
  }

  /// Returns Delta E under the environment, averaged over the repetitions.
  [[nodiscard]] double error_of(const judged_material& material, Eigen::Index count, const error_choice& choice,
                                const std::string& model) const {
    if (count == 0)
      return error_of(material, gonio::model::fit_observations(material.truth, given_.threads, choice.weighting()),
                      choice, model);
    const sampling where = random_sampling(count, given_.repetitions);
    double sum = 0.0;
    for (const std::vector<gonio::half_difference>& directions : where.sets)
      sum += error_of(material, gonio::model::fit_observations(measure(material.measured, directions, 0.0, 0)), choice,
                      model);
    return sum / static_cast<double>(where.sets.size());
  }

  [[nodiscard]] double error_of(const judged_material& material,
                                const std::vector<gonio::model::fit_observation>& observations,
                                const error_choice& choice, const std::string& model) const {
    const auto fit = fit_by_metric(choice.metric, lobes_named(model), observations, choice.options(given_.threads));
    const gonio::brdf_table table = gonio::tabulate(fit.model, library_.cells(), given_.threads);
    return judge_.difference(table, material.truth, given_.threads).environment;
  }

  const real_fits_options& given_;
  progress_bar& bar_;
  material_library library_;
  gonio::appearance_metric judge_;
  resumable_results results_;
};

void print(const real_fits_options& given, const json& rows) {
  std::cout << "Delta E env: mean (median, worst) over the materials"
            << (given.tables ? ", of fits to all cells"
                             : ", means of " + std::to_string(given.repetitions) + " random sets each")
            << ".\n\n| samples | metric | cosine-weighted | loss |" << (given.tables ? " cell weights |" : "");
  for (const std::string& model : given.models) std::cout << ' ' << model << " |";
  std::cout << "\n|---|---|---|---|" << (given.tables ? "---|" : "");
  for (std::size_t i = 0; i < given.models.size(); ++i) std::cout << "---|";
  std::string last;
  for (const json& row : rows.elements()) {
    const std::vector<json>& choice = row["choice"].elements();
    const std::string name = json{row["choice"], row["samples"]}.dump();
    if (name != last) {
      std::cout << "\n| " << (given.tables ? "all" : row["samples"].dump()) << " | " << choice[0].text() << " | "
                << (choice[2].truth() ? "yes" : "no") << " | " << choice[1].text() << " |";
      if (given.tables) std::cout << ' ' << choice[3].text() << " |";
    }
    last = name;
    std::cout << ' ' << fixed(row["mean"].number(), 2) << " (" << fixed(row["median"].number(), 2) << ", "
              << fixed(row["worst"].number(), 1) << ") |";
  }
  std::cout << '\n';
}

}  // namespace

void add_real_fits(command& app, const team& processes) {
  auto command = app.add_subcommand("real-fits", "Fit analytic models to measured materials, with every error measure");
  const auto options = std::make_shared<real_fits_options>();
  command.add_input_folder("--materials", options->materials, {".bsdf"}, "Folder of measured materials (.bsdf)")
      .required();
  command.add_option("--models", options->models, "Models as gonio fit names them").capture_default_str();
  command.add_option("--metrics", options->metrics, "Metrics")
      .check(check::one_of({"lin", "log", "cubic"}))
      .capture_default_str();
  command.add_option("--losses", options->losses, "Loss functions of the residuals")
      .check(check::one_of({"l1", "l2", "huber"}))
      .capture_default_str();
  command.add_option("--random", options->random, "Numbers of random directions").capture_default_str();
  command.add_option("--repetitions", options->repetitions, "Number of random sets of each size")
      .check(check::positive_number())
      .capture_default_str();
  command.add_flag("--tables", options->tables, "Fit all cells of tables, with each kind of cell weight");
  add_thin_option(command, options->thin);
  add_resumable_options(command, *options);
  do_together(command, processes, options, [](const auto& given) {
    run_and_print<fits_experiment>(given, [&](const json& rows) { print(given, rows); });
  });
}

}  // namespace papers
