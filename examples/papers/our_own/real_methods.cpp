/// gonio-papers real-methods: every method of gonio reconstruct on measured materials whose families were left out.

#include "papers/distribution.hpp"
#include "papers/experiments.hpp"
#include "papers/our_own/left_out_families.hpp"
#include "tool/files/json.hpp"
#include "tool/options/scattered_samples.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/basis/expand_materials.hpp>
#include <gonio/basis/learn_pca.hpp>
#include <gonio/basis/rbf.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/estimate/reconstruction.hpp>
#include <gonio/evaluate/comparison.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/interpolate/pull_push.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/robust/robust_reconstruction.hpp>

#include <iostream>
#include <map>
#include <memory>
#include <optional>

namespace papers {

namespace {

struct real_methods_options : left_out_options {
  std::vector<Eigen::Index> random{1, 5, 20, 100, 500, 2000};
  std::vector<double> wrong{0.0};
  std::vector<std::string> methods{"median", "pca", "robust", "linear", "correction", "rbf", "pull-push", "scattered"};
  Eigen::Index repetitions = 2;
};

/// Everything learned without one family. Parts that only some methods need are made on demand.
class learned {
 public:
  learned(const material_library& library, const std::string& family, Eigen::Index components,
          gonio::thread_count threads)
      : threads_(threads), prior_(library.prior_without(family, components)) {}

  [[nodiscard]] const gonio::log_relative_pca& prior() const noexcept { return prior_; }

  /// Returns the materials expanded from the prior, as in `gonio reconstruct`.
  [[nodiscard]] const gonio::measured<gonio::log>& materials() {
    if (!materials_) materials_.emplace(gonio::expand(prior_, threads_), gonio::log{}, threads_);
    return *materials_;
  }

  [[nodiscard]] const gonio::correction& corrections() {
    if (!corrections_) corrections_.emplace(materials(), gonio::correction_rule{}, gonio::nnls{}, threads_);
    return *corrections_;
  }

 private:
  gonio::thread_count threads_;
  gonio::log_relative_pca prior_;
  std::optional<gonio::measured<gonio::log>> materials_;
  std::optional<gonio::correction> corrections_;
};

class tool_methods {
 public:
  tool_methods(learned& known, gonio::thread_count threads) : known_(known), threads_(threads) {}

  [[nodiscard]] gonio::brdf_table estimate(const std::string& method, const gonio::sample_set& samples) const {
    const gonio::valid_cells& cells = known_.prior().cells();
    if (method == "median") return median();
    if (method == "pca" || method == "keeping") return components(samples, method == "pca");
    if (method == "linear")
      return gonio::decomposition{known_.materials(), gonio::nnls{}, threads_}.fit(samples).tabulate(cells, threads_);
    if (method == "rbf") {
      const gonio::valid_cells all;
      static const auto centres = gonio::farthest_point_centres(all, gonio::published_centre_count, 0);
      const gonio::rbf functions{all, gonio::log{}, centres};
      return gonio::decomposition{functions, gonio::tikhonov{1e-6}, threads_}.fit(samples).tabulate(cells, threads_);
    }
    if (method == "pull-push") return gonio::pull_push{gonio::valid_cells(), threads_}.fit(samples).table();
    if (method == "scattered") return gonio::tabulate(interpolate(samples, {}), cells, threads_);
    if (method == "nearest") return gonio::tabulate(interpolate(samples, {.neighbours = 1}), cells, threads_);
    return gonio::robust_reconstruction{known_.materials(), known_.corrections(), {}, {}, threads_}
        .fit(samples)
        .tabulate(cells, threads_);
  }

 private:
  [[nodiscard]] gonio::brdf_table median() const {
    gonio::brdf_table table(known_.prior().cells());
    for (Eigen::Index cell = 0; cell < table.cells().size(); ++cell)
      table.set(cell, gonio::rgb::Constant(known_.prior().metric().inverse(0.0, cell)));
    return table;
  }

  [[nodiscard]] gonio::brdf_table components(const gonio::sample_set& samples, bool rejecting) const {
    const gonio::reconstruction both{known_.prior(), {}, threads_};
    return (rejecting ? both : both.keeping_all()).fit(samples).tabulate(known_.prior().cells());
  }

  learned& known_;
  gonio::thread_count threads_;
};

class methods_experiment : left_out_experiment {
 public:
  methods_experiment(const real_methods_options& given, progress_bar& bar)
      : left_out_experiment(given, bar), given_(given) {}

  /// Returns a row for each number of samples, share of outliers and method, with the errors of each material averaged
  /// over the repetitions.
  [[nodiscard]] json run() {
    std::map<std::string, json> errors;  // by the row's name
    for (const judged_material& material : measured_materials(given_.materials, library_))
      for (const Eigen::Index count : given_.random)
        for (const double wrong : given_.wrong)
          for (const std::string& method : given_.methods) {
            const json key{method, count, wrong, material.name, given_.components, given_.repetitions};
            errors[row_name(count, wrong, method)][material.name] =
                once(key, material.turn, material.name + " " + std::to_string(count) + " " + method,
                     [&] { return errors_of(material, count, wrong, method); });
          }
    json rows = json::array();
    for (const Eigen::Index count : given_.random)
      for (const double wrong : given_.wrong)
        for (const std::string& method : given_.methods)
          rows.push_back({{"samples", count},
                          {"wrong", wrong},
                          {"method", method},
                          {"materials", errors.at(row_name(count, wrong, method))}});
    return rows;
  }

 private:
  [[nodiscard]] static std::string row_name(Eigen::Index count, double wrong, const std::string& method) {
    return json{count, wrong, method}.dump();
  }

  /// Returns everything learned without a family. Keeps only the last result, because materials of one family follow
  /// one another.
  [[nodiscard]] learned& without(const std::string& family) {
    if (!known_ || family_ != family) {
      known_.reset();
      known_.emplace(library_, family, given_.components, given_.threads);
      family_ = family;
    }
    return *known_;
  }

  [[nodiscard]] json errors_of(const judged_material& material, Eigen::Index count, double wrong,
                               const std::string& method) {
    const sampling where = random_sampling(count, given_.repetitions);
    const auto times = static_cast<double>(where.sets.size());
    const tool_methods tool(without(material.family), given_.threads);
    double rms = 0.0, environment = 0.0, lights = 0.0;
    for (Eigen::Index r = 0; r < std::ssize(where.sets); ++r) {
      const std::uint64_t seed = 1000 * material.number + r;
      const gonio::brdf_table& truth = material.truth;
      const gonio::sample_set samples =
          gonio::corrupt(measure(material.measured, where.sets[r], 0.0, seed), {.outlier_ratio = wrong}, seed + 100,
                         [&](std::mt19937_64& generator) {
                           std::uniform_int_distribution<Eigen::Index> any(0, truth.cells().size() - 1);
                           return truth.at(any(generator));
                         });
      const gonio::comparison errors = compare(tool.estimate(method, samples), material);
      rms += errors.mapped_rms.mean() / times;
      environment += errors.delta_e_env / times;
      lights += errors.delta_e_lights / times;
    }
    return {{"mapped_rms", rms}, {"delta_e_env", environment}, {"delta_e_lights", lights}};
  }

  const real_methods_options& given_;
  std::string family_;
  std::optional<learned> known_;
};

std::map<std::string, double> environment_of(const json& materials) {
  std::map<std::string, double> found;
  if (materials.is_object())
    for (const auto& [name, errors] : materials.items()) found[name] = errors["delta_e_env"].number();
  return found;
}

/// Returns the ratios of `errors` to `others`, material by material; empty if `others` is empty.
std::vector<double> ratios_of(const std::map<std::string, double>& errors,
                              const std::map<std::string, double>& others) {
  std::vector<double> ratios;
  for (const auto& [name, error] : others) ratios.push_back(errors.at(name) / error);
  return ratios;
}

std::string beyond(const std::vector<double>& ratios, double limit) {
  if (ratios.empty()) return "-";
  return std::to_string(std::ranges::count_if(ratios, [limit](double ratio) { return ratio > limit; }));
}

void print(const real_methods_options& given, const json& rows) {
  std::cout << "Errors of " << rows[0]["materials"].size() << " materials, random sets of each: " << given.repetitions
            << ".\n\n| samples | wrong | method | mapped rms, mean | Delta E env, mean | median | worst | Delta E "
               "lights, mean | Delta E env over pca's, median | beyond pca's | beyond twice pca's | beyond the median "
               "material's |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  std::map<std::string, std::map<std::string, double>> pca, median;  // by sampling
  const auto sampled = [](const json& row) { return json{row["samples"], row["wrong"]}.dump(); };
  for (const json& row : rows.elements()) {
    if (row["method"] == "pca") pca[sampled(row)] = environment_of(row["materials"]);
    if (row["method"] == "median") median[sampled(row)] = environment_of(row["materials"]);
  }
  for (const json& row : rows.elements()) {
    std::vector<double> rms, environment, lights;
    for (const auto& [name, errors] : row["materials"].items()) {
      rms.push_back(errors["mapped_rms"].number());
      environment.push_back(errors["delta_e_env"].number());
      lights.push_back(errors["delta_e_lights"].number());
    }
    const distribution seen(environment);
    const auto errors = environment_of(row["materials"]);
    const std::vector<double> of_pca = ratios_of(errors, pca[sampled(row)]),
                              of_median = ratios_of(errors, median[sampled(row)]);
    std::cout << "| " << row["samples"] << " | " << fixed(100.0 * row["wrong"].number(), 0) << " % | "
              << row["method"].text() << " | " << fixed(distribution(rms).mean, 3) << " | " << fixed(seen.mean, 2)
              << " | " << fixed(seen.median, 2) << " | " << fixed(seen.worst, 1) << " | "
              << fixed(distribution(lights).mean, 2) << " | "
              << (of_pca.empty() ? "-" : fixed(distribution(of_pca).median, 2)) << " | " << beyond(of_pca, 1.0) << " | "
              << beyond(of_pca, 2.0) << " | " << beyond(of_median, 1.0) << " |\n";
  }
}

}  // namespace

void add_real_methods(command& app, const team& processes) {
  auto command = app.add_subcommand("real-methods",
                                    "Reconstruct measured materials by every method, with their families left out");
  const auto options = std::make_shared<real_methods_options>();
  add_left_out_options(command, *options);
  command.add_option("--random", options->random, "Numbers of random directions").capture_default_str();
  command
      .add_option("--wrong", options->wrong,
                  "Shares of the samples that have the value of another direction (Noell et al. 2014, section 3.1)")
      .capture_default_str();
  command
      .add_option("--methods", options->methods,
                  "Methods of gonio reconstruct; keeping: pca without looking for wrong samples; median: the median of "
                  "all materials, whatever the samples; nearest: the nearest sample")
      .check(check::one_of(
          {"median", "pca", "keeping", "linear", "correction", "rbf", "pull-push", "scattered", "nearest"}))
      .capture_default_str();
  command.add_option("--repetitions", options->repetitions, "Number of random sets of each size")
      .check(check::positive_number())
      .capture_default_str();
  do_together(command, processes, options, [](const auto& given) {
    run_and_print<methods_experiment>(given, [&](const json& rows) { print(given, rows); });
  });
}

}  // namespace papers
