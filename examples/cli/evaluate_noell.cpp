/// gonio evaluate noell-table1, noell-table2: the benchmark of Noell, Koehler and Stricker 2014, section 3.1.

#include "evaluate.hpp"
#include "noell_experiment.hpp"
#include "progress_bar.hpp"

#include <algorithm>
#include <fstream>
#include <iostream>
#include <memory>

namespace cli {

namespace {

struct noell_options {
  std::filesystem::path networks, environment, state;
  std::string materials = "test";
  std::vector<std::string> methods;
  std::vector<double> data_ratios, outlier_ratios;
  std::vector<std::uint64_t> seeds{1};
  bool print_json = false;
  gonio::thread_count threads;
};

/// Results that earlier runs left in a file, one JSON object a line; new ones are appended as they come.
class resumable_results {
 public:
  explicit resumable_results(const std::filesystem::path& path) : path_(path) {
    if (path.empty()) return;
    std::ifstream earlier(path);
    for (std::string line; std::getline(earlier, line);) {
      // A run that was killed may have left half a line.
      const json entry = json::parse(line, nullptr, false);
      if (entry.is_object() && entry.contains("key") && entry.contains("result")) entries_.push_back(entry);
    }
    file_.open(path, std::ios::app);
    if (!file_) throw gonio::error("cannot write '" + path.string() + "'");
    if (!entries_.empty()) file_ << '\n';
  }

  [[nodiscard]] const json* find(const json& key) const {
    const auto found = std::ranges::find_if(entries_, [&](const json& entry) { return entry["key"] == key; });
    return found == entries_.end() ? nullptr : &*found;
  }

  void add(const json& key, const json& result) {
    entries_.push_back({{"key", key}, {"result", result}});
    if (!file_.is_open()) return;
    file_ << entries_.back().dump() << std::endl;
    if (!file_) throw gonio::error("cannot write '" + path_.string() + "'");
  }

 private:
  std::filesystem::path path_;
  std::vector<json> entries_;
  std::ofstream file_;
};

[[nodiscard]] std::vector<std::string> chosen_materials(const std::string& choice,
                                                        const std::vector<std::string>& names) {
  if (choice == "test") return gonio::nielsen_test_materials();
  if (choice == "all") return names;
  if (std::ranges::find(names, choice) == names.end())
    throw gonio::error("--materials is test, all or the name of one, not '" + choice + "'");
  return {choice};
}

/// Mean, median, worst and range of the peak ratio, as a row's cells.
[[nodiscard]] std::string summary(const std::vector<json>& results, const std::string& measure) {
  std::vector<double> values, peaks;
  for (const json& result : results) {
    values.push_back(result[measure]);
    peaks.push_back(result["peak_ratio"]);
  }
  std::ranges::sort(values);
  std::ranges::sort(peaks);
  double sum = 0.0;
  for (const double value : values) sum += value;
  const auto count = static_cast<double>(values.size());
  return fixed(sum / count, 2) + " | " + fixed((values[values.size() / 2] + values[(values.size() - 1) / 2]) / 2.0, 2) +
         " | " + fixed(values.back(), 2) + " | " + fixed(peaks.front(), 2) + " - " + fixed(peaks.back(), 2);
}

[[nodiscard]] std::string printed(const std::optional<double>& figure) { return figure ? fixed(*figure, 2) : ""; }

/// One experiment: every method on every material in every setting.
class noell_sweep {
 public:
  noell_sweep(const noell_options& options, const gonio::progress& listener)
      : options_(options),
        results_(options.state),
        experiment_(options.networks, options.environment, options.threads, listener),
        listener_(listener) {
    materials_ = chosen_materials(options.materials, experiment_.names());
  }

  void run() {
    const std::size_t total = options_.data_ratios.size() * options_.outlier_ratios.size() * options_.methods.size() *
                              materials_.size() * options_.seeds.size();
    std::size_t done = 0;
    // Materials outermost: each has corrections of its own.
    for (const std::string& material : materials_)
      for (const double data_ratio : options_.data_ratios)
        for (const double outlier_ratio : options_.outlier_ratios)
          for (const std::uint64_t seed : options_.seeds)
            for (const std::string& method : options_.methods) {
              const noell_case which{material, data_ratio, outlier_ratio, seed};
              gonio::report(listener_, method + ' ' + material,
                            static_cast<double>(done++) / static_cast<double>(total));
              const json key = key_of(method, which);
              if (!results_.find(key)) results_.add(key, experiment_.run(method, which));
            }
  }

  [[nodiscard]] std::vector<json> results(const std::string& method, double data_ratio, double outlier_ratio) const {
    std::vector<json> found;
    for (const std::uint64_t seed : options_.seeds)
      for (const std::string& material : materials_)
        found.push_back((*results_.find(key_of(method, {material, data_ratio, outlier_ratio, seed})))["result"]);
    return found;
  }

  [[nodiscard]] std::size_t materials() const noexcept { return materials_.size(); }

 private:
  [[nodiscard]] json key_of(const std::string& method, const noell_case& which) const {
    return {method,           which.material,
            which.data_ratio, which.outlier_ratio,
            which.seed,       options_.environment.filename().string()};
  }

  noell_options options_;
  resumable_results results_;
  noell_experiment experiment_;
  gonio::progress listener_;
  std::vector<std::string> materials_;
};

void print_json(const noell_options& options, const noell_sweep& sweep) {
  json all = json::array();
  for (const std::string& method : options.methods)
    for (const double data_ratio : options.data_ratios)
      for (const double outlier_ratio : options.outlier_ratios)
        all.push_back({{"method", method},
                       {"data_ratio", data_ratio},
                       {"outlier_ratio", outlier_ratio},
                       {"results", sweep.results(method, data_ratio, outlier_ratio)}});
  std::cout << all.dump(1) << '\n';
}

void print_table(const noell_options& options, const noell_sweep& sweep) {
  const bool natural = !options.environment.empty();
  std::cout << "Mean Delta E over the sphere; mean, median and worst of " << sweep.materials() << " materials x "
            << options.seeds.size() << " outlier seeds, and the range of the peak ratio (green).\n\n"
            << "| method | data | outliers | paper | formula light: mean | median | worst | peak ratio |"
            << (natural ? " natural light: mean | median | worst | peak ratio |\n" : "\n")
            << "|---|---|---|---|---|---|---|---|" << (natural ? "---|---|---|---|\n" : "\n");
  for (const std::string& method : options.methods)
    for (const double data_ratio : options.data_ratios)
      for (const double outlier_ratio : options.outlier_ratios) {
        const auto results = sweep.results(method, data_ratio, outlier_ratio);
        std::cout << "| " << method << " | " << fixed(data_ratio, data_ratio > 1.0 ? 0 : 2) << " | "
                  << fixed(outlier_ratio, 1) << " | "
                  << printed(noell_experiment::published(method, data_ratio, outlier_ratio)) << " | "
                  << summary(results, "delta_e_env") << " |";
        if (natural) std::cout << ' ' << summary(results, "delta_e_natural") << " |";
        std::cout << '\n';
      }
}

void run_noell(const noell_options& options) {
  progress_bar bar;
  noell_sweep sweep(options, bar.listener());
  sweep.run();
  bar.wipe();
  if (options.print_json)
    print_json(options, sweep);
  else
    print_table(options, sweep);
}

CLI::App* add_noell(CLI::App& evaluate, const std::string& name, const std::string& description,
                    const noell_options& defaults) {
  auto* command = evaluate.add_subcommand(name, description);
  const auto options = std::make_shared<noell_options>(defaults);
  command->add_option("--networks", options->networks, "File of networks of the 100 materials (.npy)")->required();
  command->add_option("--environment", options->environment,
                      "Latitude-longitude picture of a natural light to judge under, too (.hdr)");
  command->add_option("--materials", options->materials, "test (ten of them), all, or the name of one")
      ->capture_default_str();
  command
      ->add_option(
          "--methods", options->methods,
          "Any of: our, our-start (what it starts from), printed (the paper's method as printed), gamma-G (our "
          "corrections "
          "with the paper's weights), lc, rbf, pull-push; all but gamma-G and pull-push with -lin or -root for "
          "another metric than log")
      ->check(CLI::Validator([](std::string& method) { return noell_experiment::complaint(method); }, "METHOD"))
      ->capture_default_str();
  command
      ->add_option("--data", options->data_ratios,
                   "Shares of the table that are measured, or, above 1, numbers of samples")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--outliers", options->outlier_ratios, "Shares of the measurements that are outliers")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command->add_option("--seeds", options->seeds, "Seeds of cells and outliers")->capture_default_str();
  command->add_option("--state", options->state, "File in which results are kept, so that a run can be resumed");
  command->add_flag("--json", options->print_json, "Print everything, with each material, as JSON");
  add_threads_option(*command, options->threads);
  command->callback([options] { run_noell(*options); });
  return command;
}

}  // namespace

void add_noell_tables(CLI::App& evaluate) {
  noell_options first;
  first.methods = {"our", "lc"};
  first.data_ratios.assign(gonio::noell_data_ratios.begin(), gonio::noell_data_ratios.end());
  first.outlier_ratios.assign(gonio::noell_outlier_ratios.begin(), gonio::noell_outlier_ratios.end());
  add_noell(evaluate, "noell-table1", "Noell et al. 2014, Table 1: data ratios by outlier ratios", first);

  noell_options second;
  second.methods = {"our-lin", "our-root", "our", "lc-lin", "lc-root", "lc"};
  second.data_ratios = {1.0};
  second.outlier_ratios = {0.0};
  add_noell(evaluate, "noell-table2", "Noell et al. 2014, Table 2: error metrics, from full data", second);
}

}  // namespace cli
