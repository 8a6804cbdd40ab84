/// gonio-papers noell-table1, noell-table2: the benchmark of Noell, Koehler and Stricker 2014, section 3.1.

#include "papers/distribution.hpp"
#include "papers/experiments.hpp"
#include "papers/networks_option.hpp"
#include "papers/noell2014/noell_experiment.hpp"
#include "papers/noell2014/noell_measures.hpp"
#include "papers/noell2014/noell_tables.hpp"
#include "papers/resumable_results.hpp"
#include "tool/files/json.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/evaluate/test_materials.hpp>

#include <algorithm>
#include <iostream>
#include <memory>
#include <span>

namespace papers {

namespace {

struct noell_options : resumable_options {
  std::filesystem::path networks, environment;
  std::string materials = "test";
  std::vector<std::string> methods;
  std::vector<double> data_ratios, outlier_ratios;
  std::vector<std::uint64_t> seeds{1};
  std::vector<int> iterations;  // if empty, a method stops by itself
  std::vector<int> basis;       // if empty, all other materials
  bool print_json = false;
};

[[nodiscard]] std::vector<std::string> chosen_materials(const std::string& choice,
                                                        const std::vector<std::string>& names) {
  if (choice == "test") return gonio::nielsen_test_materials();
  if (choice == "all") return names;
  if (std::ranges::find(names, choice) == names.end())
    gonio::refuse("--materials needs test, all, or the name of a material, not '" + choice + "'");
  return {choice};
}

/// The setting whose results a row of the table summarises.
struct noell_setting {
  std::string method;
  std::optional<int> iterations, basis;
  double data_ratio = 1.0, outlier_ratio = 0.0;

  [[nodiscard]] std::string name() const {
    std::string full = method;
    if (basis) full += ", " + counted(*basis, "material");
    if (iterations) full += ", " + counted(*iterations, "iteration");
    return full;
  }

 private:
  [[nodiscard]] static std::string counted(int count, const std::string& noun) {
    return std::to_string(count) + ' ' + noun + (count == 1 ? "" : "s");
  }
};

/// Returns a row's cells: mean (with its range over several seeds), median, worst, and range of the peak ratio.
/// `results` has all results of the first seed, then of the second, and so on.
[[nodiscard]] std::string summary(const std::vector<json>& results, const std::string& measure, std::size_t seeds) {
  std::vector<double> values, peaks, means;
  for (const json& result : results) {
    values.push_back(result[measure].number());
    peaks.push_back(result["peak_ratio"].number());
  }
  const std::size_t materials = values.size() / seeds;
  for (std::size_t seed = 0; seed < seeds; ++seed)
    means.push_back(distribution(std::span(values).subspan(seed * materials, materials)).mean);
  const auto [least, most] = std::ranges::minmax(means);
  const std::string spread = seeds > 1 ? " (" + fixed(least, 2) + " - " + fixed(most, 2) + ")" : "";
  const distribution all(values);
  const auto [lowest, highest] = std::ranges::minmax(peaks);
  return fixed(all.mean, 2) + spread + " | " + fixed(all.median, 2) + " | " + fixed(all.worst, 2) + " | " +
         fixed(lowest, 2) + " - " + fixed(highest, 2);
}

[[nodiscard]] std::string printed(const std::optional<double>& figure) { return figure ? fixed(*figure, 2) : ""; }

/// One experiment: every method on every material in every setting.
class noell_sweep {
 public:
  noell_sweep(const noell_options& options, const gonio::progress& listener)
      : options_(options),
        results_(options),
        experiment_(options.networks, options.environment, options.threads, listener),
        listener_(listener) {
    materials_ = chosen_materials(options.materials, experiment_.names());
  }

  void run() {
    const std::vector<noell_setting> all = settings();
    const std::size_t total = all.size() * materials_.size() * options_.seeds.size();
    std::size_t done = 0;
    prepare();
    // Materials are the outermost loop, because each has its own corrections.
    for (std::size_t m = 0; m < materials_.size(); ++m)
      for (const noell_setting& setting : all)
        for (const std::uint64_t seed : options_.seeds) {
          gonio::report(listener_, setting.method + ' ' + materials_[m],
                        static_cast<double>(done++) / static_cast<double>(total));
          const noell_case which = case_of(setting, materials_[m], seed);
          results_.once(key_of(setting.method, which), m, [&] { return experiment_.run(setting.method, which); });
        }
  }

  /// Returns a setting for each row of the table. Settings that differ only in iterations are adjacent.
  [[nodiscard]] std::vector<noell_setting> settings() const {
    std::vector<noell_setting> all;
    for (const std::string& method : options_.methods)
      for (const auto& basis : choices(options_.basis, noell_experiment::combines(method)))
        for (const double data_ratio : options_.data_ratios)
          for (const double outlier_ratio : options_.outlier_ratios)
            for (const auto& iterations : choices(options_.iterations, noell_experiment::iterates(method)))
              all.push_back({method, iterations, basis, data_ratio, outlier_ratio});
    return all;
  }

  [[nodiscard]] std::vector<json> results(const noell_setting& setting) const { return results(setting, materials_); }

  /// Returns the results of some materials with the first seed, then with the second, and so on.
  [[nodiscard]] std::vector<json> results(const noell_setting& setting, std::span<const std::string> materials) const {
    std::vector<json> found;
    for (const std::uint64_t seed : options_.seeds)
      for (const std::string& material : materials)
        found.push_back(*results_.find(key_of(setting.method, case_of(setting, material, seed))));
    return found;
  }

  [[nodiscard]] const std::vector<std::string>& materials() const noexcept { return materials_; }

 private:
  /// Returns the values of an option if a method uses it, otherwise one empty value.
  [[nodiscard]] static std::vector<std::optional<int>> choices(const std::vector<int>& given, bool of_use) {
    if (given.empty() || !of_use) return {std::nullopt};
    return {given.begin(), given.end()};
  }

  /// Prepares this process's missing cases, in groups of the same method, share of data and seed.
  void prepare() {
    for (const std::string& method : options_.methods)
      for (const double data_ratio : options_.data_ratios)
        for (const std::uint64_t seed : options_.seeds) {
          std::vector<noell_case> missing;
          for (const double outlier_ratio : options_.outlier_ratios)
            for (std::size_t m = 0; m < materials_.size(); ++m) {
              const noell_case which{materials_[m], data_ratio, outlier_ratio, seed, {}, {}};
              if (results_.is_own(m) && !results_.find(key_of(method, which))) missing.push_back(which);
            }
          gonio::report(listener_, method + ", data " + fixed(data_ratio, 2), 0.0);
          experiment_.prepare(method, missing);
        }
  }

  [[nodiscard]] static noell_case case_of(const noell_setting& setting, const std::string& material,
                                          std::uint64_t seed) {
    return {material, setting.data_ratio, setting.outlier_ratio, seed, setting.iterations, setting.basis};
  }

  [[nodiscard]] json key_of(const std::string& method, const noell_case& which) const {
    json key{method,           which.material,
             which.data_ratio, which.outlier_ratio,
             which.seed,       options_.environment.filename().string()};
    if (which.iterations) key.push_back(*which.iterations);
    if (which.basis) key.push_back(json{{"basis", *which.basis}});
    return key;
  }

  noell_options options_;
  resumable_results results_;
  noell_experiment experiment_;
  gonio::progress listener_;
  std::vector<std::string> materials_;
};

void print_json(const noell_options& options, const noell_sweep& sweep) {
  json all = json::array();
  for (const noell_setting& setting : sweep.settings()) {
    json row{{"method", setting.method}};
    if (setting.iterations) row["iterations"] = *setting.iterations;
    if (setting.basis) row["basis"] = *setting.basis;
    row["data_ratio"] = setting.data_ratio;
    row["outlier_ratio"] = setting.outlier_ratio;
    json results = json::array();
    for (const std::uint64_t seed : options.seeds)
      for (const std::string& material : sweep.materials()) results.push_back({{"material", material}, {"seed", seed}});
    const std::vector<json> measured = sweep.results(setting);
    for (std::size_t i = 0; i < measured.size(); ++i) results[i].update(measured[i]);
    row["results"] = std::move(results);
    all.push_back(std::move(row));
  }
  std::cout << all.dump(1) << '\n';
}

/// Prints how much the last number of iterations harms: the error after it, relative to the least error after any of
/// the given numbers.
void print_harm(const noell_options& options, const noell_sweep& sweep) {
  for (const noell_setting& last : sweep.settings()) {
    if (last.iterations != options.iterations.back()) continue;
    std::vector<double> harm(sweep.results(last).size(), 1.0);
    for (const int iterations : options.iterations) {
      noell_setting other = last;
      other.iterations = iterations;
      const std::vector<json> before = sweep.results(other), after = sweep.results(last);
      for (std::size_t i = 0; i < harm.size(); ++i)
        harm[i] = std::max(harm[i], after[i]["delta_e_env"].number() / before[i]["delta_e_env"].number());
    }
    const auto worst = std::ranges::max_element(harm);
    const std::size_t material = (worst - harm.begin()) % sweep.materials().size();
    std::cout << last.name() << ", data " << last.data_ratio << ", outliers " << last.outlier_ratio << ": at most "
              << fixed(*worst, 3) << " times the best (" << sweep.materials()[material] << "); more than 1.05 times in "
              << std::ranges::count_if(harm, [](double ratio) { return ratio > 1.05; }) << " of " << harm.size()
              << " cases\n";
  }
}

/// Prints the time per round, from the longest and the shortest runs. It is too short if a method stops early.
void print_seconds(const noell_options& options, const noell_sweep& sweep) {
  const auto [fewest, most] = std::ranges::minmax(options.iterations);
  std::cout << "\nSeconds per iteration: mean (least - most). The paper: \"a few seconds\".\n\n"
               "| method | data | outliers | seconds |\n|---|---|---|---|\n";
  for (noell_setting setting : sweep.settings()) {
    if (setting.iterations != most) continue;
    const std::vector<json> long_runs = sweep.results(setting);
    setting.iterations = fewest;
    const std::vector<json> short_runs = sweep.results(setting);
    std::vector<double> seconds;
    for (std::size_t i = 0; i < long_runs.size(); ++i)
      seconds.push_back((long_runs[i]["seconds"].number() - short_runs[i]["seconds"].number()) / (most - fewest));
    const auto [least, longest] = std::ranges::minmax(seconds);
    setting.iterations.reset();
    std::cout << "| " << setting.name() << " | " << fixed(setting.data_ratio, setting.data_ratio > 1.0 ? 0 : 2) << " | "
              << fixed(setting.outlier_ratio, 1) << " | " << fixed(distribution(seconds).mean, 2) << " ("
              << fixed(least, 2) << " - " << fixed(longest, 2) << ") |\n";
  }
}

/// Returns the materials on which no default was tuned.
[[nodiscard]] std::vector<std::string> unseen(std::vector<std::string> materials) {
  const auto seen = gonio::nielsen_test_materials();
  std::erase_if(materials, [&](const std::string& name) {
    return std::ranges::count(seen, name) > 0 || std::ranges::count(noell_tuned_materials, name) > 0;
  });
  return materials;
}

void print_table(const noell_options& options, const noell_sweep& sweep, std::span<const std::string> materials,
                 const std::string& which) {
  const bool natural = !options.environment.empty();
  std::cout << "Delta E, averaged over the sphere: mean, median and worst over " << materials.size() << ' ' << which
            << " x " << counted(std::ssize(options.seeds), "outlier seed")
            << ", and the range of the peak ratio in the green channel.\n\n"
            << "| method | data | outliers | paper | formula light: mean | median | worst | peak ratio |"
            << (natural ? " natural light: mean | median | worst | peak ratio |\n" : "\n")
            << "|---|---|---|---|---|---|---|---|" << (natural ? "---|---|---|---|\n" : "\n");
  for (const noell_setting& setting : sweep.settings()) {
    const auto& [method, iterations, basis, data_ratio, outlier_ratio] = setting;
    const auto results = sweep.results(setting, materials);
    std::cout << "| " << setting.name() << " | " << fixed(data_ratio, data_ratio > 1.0 ? 0 : 2) << " | "
              << fixed(outlier_ratio, 1) << " | "
              << printed(noell_experiment::published(method, data_ratio, outlier_ratio)) << " | "
              << summary(results, "delta_e_env", options.seeds.size()) << " |";
    if (natural) std::cout << ' ' << summary(results, "delta_e_natural", options.seeds.size()) << " |";
    std::cout << '\n';
  }
}

/// Prints the share of outliers that each estimate reports, beside the true share. Each row has one amount of data.
void print_outliers(const noell_options& options, const noell_sweep& sweep) {
  const auto reports = [&](const noell_setting& setting) {
    return sweep.results(setting).front().contains("outliers");
  };
  if (std::ranges::none_of(sweep.settings(), reports)) return;
  std::cout
      << "\nReported share of outliers, %: mean over materials and seeds (least - most); in brackets how many of the "
         "samples are more than 5 % off.\n\n| method | data |";
  for (const double ratio : options.outlier_ratios) std::cout << " true: " << fixed(100.0 * ratio, 0) << " |";
  std::cout << "\n|---|---|";
  for (std::size_t i = 0; i < options.outlier_ratios.size(); ++i) std::cout << "---|";
  std::optional<std::pair<std::string, double>> row;
  for (const noell_setting& setting : sweep.settings()) {
    if (!reports(setting)) continue;
    std::vector<double> reported, off;
    for (const json& result : sweep.results(setting)) {
      reported.push_back(100.0 * result["outliers"].number());
      off.push_back(100.0 * result["off"].number());
    }
    if (const std::pair own{setting.name(), setting.data_ratio}; row != own) {
      row = own;
      std::cout << "\n| " << own.first << " | " << fixed(own.second, own.second > 1.0 ? 0 : 2) << " |";
    }
    const auto [least, most] = std::ranges::minmax(reported);
    std::cout << ' ' << fixed(distribution(reported).mean, 1) << " (" << fixed(least, 1) << " - " << fixed(most, 1)
              << ") [" << fixed(distribution(off).mean, 1) << "] |";
  }
  std::cout << '\n';
}

void run_noell(const noell_options& options) {
  progress_bar bar;
  noell_sweep sweep(options, bar.listener());
  sweep.run();
  if (!options.prints()) return;
  bar.wipe();
  if (options.print_json) return print_json(options, sweep);
  print_table(options, sweep, sweep.materials(), "materials");
  if (const auto others = unseen(sweep.materials()); !others.empty() && others.size() < sweep.materials().size()) {
    std::cout << '\n';
    print_table(options, sweep, others, "materials (on which no default was chosen)");
  }
  if (options.iterations.size() > 1) {
    std::cout << '\n';
    print_harm(options, sweep);
    print_seconds(options, sweep);
  }
  if (options.iterations.empty()) print_outliers(options, sweep);
}

void add_noell(command& app, const std::string& name, const std::string& description, const noell_options& defaults,
               const team& processes) {
  auto command = app.add_subcommand(name, description);
  const auto options = std::make_shared<noell_options>(defaults);
  // Declare the materials, their methods and the environment.
  add_networks_option(command, options->networks);
  add_environment_option(command, options->environment);
  command
      .add_option("--materials", options->materials,
                  "Materials: test (the ten test materials), all, or the name of one material")
      .capture_default_str();
  command
      .add_option("--methods", options->methods,
                  "Methods: our, printed (the paper's method as printed), gamma-G (our corrections with the paper's "
                  "weights), lc, rbf, pull-push, scattered. The metric is log; our, printed, lc and rbf use another "
                  "metric if -lin or -root follows")
      .check(check::without([](const std::string& method) { return noell_experiment::complaint(method); }, "METHOD"))
      .capture_default_str();
  // Declare the measurements.
  command
      .add_option("--data", options->data_ratios,
                  "Shares of the table that are measured, or, above 1, numbers of samples")
      .check(check::positive_number())
      .capture_default_str();
  command.add_option("--outliers", options->outlier_ratios, "Shares of the measurements that are outliers")
      .check(check::range(0.0, 1.0))
      .capture_default_str();
  command.add_option("--seeds", options->seeds, "Seeds of cells and outliers").capture_default_str();
  // Declare the run and its output.
  command
      .add_option("--iterations", options->iterations,
                  "Numbers of rounds to compare; 0 is the initial estimate. Default: a method stops by itself, after "
                  "at most 10 rounds")
      .check(check::non_negative_number());
  command
      .add_option("--basis", options->basis,
                  "Numbers of other materials, drawn at random, that a method combines (default: all)")
      .check(check::positive_number());
  command.add_flag("--json", options->print_json, "Print everything, with each material, as JSON");
  add_resumable_options(command, *options);
  do_together(command, processes, options, run_noell);
}

}  // namespace

void add_noell_tables(command& app, const team& processes) {
  noell_options first;
  first.methods = {"our", "lc"};
  first.data_ratios.assign(noell_data_ratios.begin(), noell_data_ratios.end());
  first.outlier_ratios.assign(noell_outlier_ratios.begin(), noell_outlier_ratios.end());
  add_noell(app, "noell-table1", "Noell et al. 2014, Table 1: data ratios by outlier ratios", first, processes);

  noell_options second;
  second.methods = {"our-lin", "our-root", "our", "printed-lin", "printed-root", "printed",
                    "lc-lin",  "lc-root",  "lc",  "rbf-lin",     "rbf-root",     "rbf"};
  second.data_ratios = {1.0};
  second.outlier_ratios = {0.0};
  add_noell(app, "noell-table2", "Noell et al. 2014, Table 2: error metrics, from full data", second, processes);
}

}  // namespace papers
