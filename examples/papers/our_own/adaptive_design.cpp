/// gonio-papers adaptive-design: measured materials, whose families the prior has not seen, measured in directions that
/// the readings so far choose, and in fixed ones.

#include "papers/distribution.hpp"
#include "papers/experiments.hpp"
#include "papers/nielsen2015/nielsen_split.hpp"
#include "papers/our_own/left_out_families.hpp"
#include "tool/files/json.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/core/statistics.hpp>
#include <gonio/estimate/reconstruction.hpp>
#include <gonio/evaluate/comparison.hpp>
#include <gonio/evaluate/next_measurement.hpp>

#include <iostream>
#include <map>
#include <memory>
#include <optional>

namespace papers {

namespace {

struct adaptive_options : left_out_options {
  std::filesystem::path folder = shipped_directions();
  std::vector<Eigen::Index> counts{5, 6, 8, 10, 12, 15, 20};
  std::vector<std::string> methods{"perceived", "expected-error", "mean-material", "first-five", "adaptive"};
};

using estimator_type = gonio::reconstruction<gonio::log_relative>;
using chooser_type = gonio::measurement_chooser<gonio::log_relative>;

/// What is prepared for the materials of one family.
struct family_setup {
  estimator_type estimator;
  chooser_type chooser;
};

class adaptive_experiment : left_out_experiment {
 public:
  adaptive_experiment(const adaptive_options& given, progress_bar& bar)
      : left_out_experiment(given, bar), given_(given) {}

  /// A row for each number of samples and method: errors of each material.
  [[nodiscard]] json run() {
    const std::vector<judged_material> materials = measured_materials(given_.materials, library_);
    std::map<std::pair<Eigen::Index, std::string>, json> found;
    for (const judged_material& material : materials)
      for (const std::string& method : given_.methods) {
        json counts = json::array();
        for (const Eigen::Index count : given_.counts) counts.push_back(count);
        const json key{"adaptive", method, material.name, given_.components, counts};
        const json& by_count =
            once(key, material.turn, material.name + " " + method, [&] { return errors_by_count(material, method); });
        if (by_count.is_null()) continue;  // another process'
        for (const auto& [count, errors] : by_count.items()) found[{std::stol(count), method}][material.name] = errors;
      }
    json rows = json::array();
    for (const Eigen::Index count : given_.counts)
      for (const std::string& method : given_.methods)
        if (const auto row = found.find({count, method}); row != found.end())
          rows.push_back({{"samples", count}, {"method", method}, {"materials", row->second}});
    return rows;
  }

 private:
  [[nodiscard]] Eigen::Index most() const { return std::ranges::max(given_.counts); }

  /// Of the family that was asked for last: families are judged one after the other.
  const family_setup& setup_without(const std::string& family) {
    if (setup_ && family_ == family) return *setup_;
    setup_.reset();
    const auto estimator =
        estimator_type{library_.prior_without(family, given_.components), {}, given_.threads}.keeping_all();
    chooser_type chooser{estimator, {}, gonio::design::default_candidates(), given_.threads};
    setup_.emplace(family_setup{estimator, std::move(chooser)});
    family_ = family;
    return *setup_;
  }

  json errors_by_count(const judged_material& material, const std::string& method) {
    const family_setup& with = setup_without(material.family);
    json all = json::object();
    if (method == "perceived" || method == "expected-error") {
      for (const Eigen::Index count : given_.counts)
        if (const auto points = written_points(given_.folder, method, count))
          all[std::to_string(count)] = errors_of(material, measure(material.measured, *points, 0.0, 0), with);
      return all;
    }
    const auto first = written_points(given_.folder, "perceived", 5);
    if (!first) gonio::refuse("there is no set by perceived of 5 directions");
    gonio::sample_set samples = measure(material.measured, *first, 0.0, 0);
    std::vector<gonio::next_measurement> planned;
    if (method != "adaptive")
      planned = with.chooser.choose(
          method == "first-five" ? samples : of_mean_material(samples, with.estimator.prior()), most() - 5);
    while (true) {
      const Eigen::Index count = samples.size();
      if (std::ranges::find(given_.counts, count) != given_.counts.end())
        all[std::to_string(count)] = errors_of(material, samples, with);
      if (count >= most()) return all;
      const gonio::half_difference next =
          method == "adaptive" ? with.chooser.choose(samples, 1).front().angles : planned[count - 5].angles;
      samples.push_back({next, material.measured(gonio::to_directions(next)), 1.0});
    }
  }

  json errors_of(const judged_material& material, const gonio::sample_set& samples, const family_setup& with) {
    const auto paint = with.estimator.fit(samples);
    const gonio::comparison errors = compare(paint.tabulate(library_.cells()), material);
    const gonio::valid_cells& candidates = with.chooser.candidates().geometry().cells();
    std::vector<double> deviations(candidates.size());
    for (Eigen::Index cell = 0; cell < candidates.size(); ++cell)
      deviations[cell] = paint.deviation(gonio::locate(with.estimator.cells(), candidates.angles(cell)));
    return {{"mapped_rms", errors.mapped_rms.mean()},     {"delta_e_env", errors.delta_e_env},
            {"delta_e_lights", errors.delta_e_lights},    {"deviation", gonio::median(deviations)},
            {"least_peak", errors.peak_ratio.minCoeff()}, {"largest_peak", errors.peak_ratio.maxCoeff()}};
  }

  const adaptive_options& given_;
  std::string family_;
  std::optional<family_setup> setup_;
};

void print(const json& rows) {
  std::cout << "Means (medians) over " << rows[0]["materials"].size() << " materials.\n\n"
            << "| samples | directions | mapped rms | Delta E env | Delta E lights | peak, least to largest | median "
               "deviation that is stated |\n|---|---|---|---|---|---|---|\n";
  for (const json& row : rows.elements()) {
    std::map<std::string, std::vector<double>> values;
    for (const auto& [name, errors] : row["materials"].items())
      for (const auto& [key, value] : errors.items()) values[key].push_back(value.number());
    const auto mean_and_median = [&](const char* key, int digits) {
      const distribution found(values[key]);
      return fixed(found.mean, digits) + " (" + fixed(found.median, digits) + ")";
    };
    std::cout << "| " << fixed(row["samples"].number(), 0) << " | " << row["method"].text() << " | "
              << mean_and_median("mapped_rms", 3) << " | " << mean_and_median("delta_e_env", 2) << " | "
              << mean_and_median("delta_e_lights", 2) << " | " << fixed(std::ranges::min(values["least_peak"]), 2)
              << " to " << fixed(std::ranges::max(values["largest_peak"]), 2) << " | "
              << mean_and_median("deviation", 3) << " |\n";
  }
}

}  // namespace

void add_adaptive_design(command& app, const team& processes) {
  auto command =
      app.add_subcommand("adaptive-design", "Measure materials where the readings so far say, and in fixed directions");
  const auto options = std::make_shared<adaptive_options>();
  add_left_out_options(command, *options);
  command.add_input_folder("--directions", options->folder, {".csv"}, "Folder of designed sets");
  command.add_option("-n,--counts", options->counts, "Numbers of samples that are judged").capture_default_str();
  command
      .add_option(
          "--methods", options->methods,
          "perceived, expected-error: designed sets; mean-material, first-five, adaptive: five by the perceived "
          "norm, and further ones as if the prior's mean were measured, from what the five read, or each from "
          "all that was read before")
      .check(check::one_of({"perceived", "expected-error", "mean-material", "first-five", "adaptive"}))
      .capture_default_str();
  do_together(command, processes, options, [](const auto& given) {
    if (std::ranges::min(given.counts) < 5) gonio::refuse("--counts needs numbers of at least 5");
    run_and_print<adaptive_experiment>(given, print);
  });
}

}  // namespace papers
