/// gonio-papers noell-gap: why outliers harm the linear combination (LC) of Noell, Koehler and Stricker 2014 less in
/// their Table 1 than here. Varies the details that the paper leaves open, one at a time.

#include "papers/experiments.hpp"
#include "papers/networks_option.hpp"
#include "papers/noell2014/noell_experiment.hpp"
#include "papers/noell2014/planned_decomposition.hpp"
#include "papers/resumable_results.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/core/vector_kernels.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/evaluate/sphere_delta_e.hpp>
#include <gonio/evaluate/test_materials.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/metric/location_free.hpp>
#include <gonio/render/environment_map.hpp>
#include <gonio/solve/least_squares.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iostream>
#include <memory>
#include <numbers>
#include <random>
#include <span>

namespace papers {

namespace {

/// ln(1 + scale rho): the paper's metric with reflectance in a unit other than sr^-1.
struct scaled_log : gonio::location_free_metric<scaled_log> {
  double scale = 1.0;

  explicit scaled_log(double unit) : scale(unit) {}
  [[nodiscard]] double map(double rho) const noexcept { return std::copysign(std::log1p(scale * std::abs(rho)), rho); }
  [[nodiscard]] double unmap(double y) const noexcept { return std::copysign(std::expm1(std::abs(y)), y) / scale; }
  void unmap_all(std::span<float> values) const {
    const float unit = 1.0f / static_cast<float>(scale);
    gonio::map_by_sixteens(values.data(), std::ssize(values),
                           [&](auto& these) { these = unit * (these.max(0.0f).exp() - 1.0f); });
  }
};

static_assert(gonio::error_metric<scaled_log>);

/// The source of an outlier's value.
enum class outlier_source { valid_cells, all_cells, each_channel, angles, directions };

struct named_source {
  outlier_source source;
  const char* name;
};
constexpr std::array all_sources{
    named_source{outlier_source::valid_cells, "outliers from valid cells"},
    named_source{outlier_source::all_cells, "outliers from all 1,458,000 cells, empty ones 0"},
    named_source{outlier_source::each_channel, "outliers in each channel by itself"},
    named_source{outlier_source::angles, "outliers from random angles theta_h, theta_d, phi_d"},
    named_source{outlier_source::directions, "outliers from random directions"}};

constexpr std::array samples_too{named_source{outlier_source::angles, "samples and outliers of random angles"}};
constexpr std::array cells_and_angles{all_sources[0], all_sources[3]};

/// The locations of samples: random cells, a quarter of which have theta_h below 6 degrees, or random angles.
enum class sampling { cells, angles };

/// The exposure of the spheres: the truth's sphere, or with `of_white` a white sphere, has this mean luminance.
struct judgement {
  std::string name;
  double luminance = gonio::sphere_delta_e::middle_grey;
  bool of_white = false;
};
const std::array judgements{judgement{"the truth's sphere has mean luminance 0.18"},
                            judgement{"a white sphere has mean luminance 0.18", 0.18, true}};

struct gap_options : resumable_options {
  std::filesystem::path networks, environment;
  double data_ratio = 0.1;
  std::vector<double> outlier_ratios{noell_outlier_ratios.begin(), noell_outlier_ratios.end()};
  std::vector<double> scales{10.0};
  std::vector<std::string> materials = gonio::nielsen_test_materials();
  std::vector<std::string> methods{"lc", "rbf", "pull-push", "printed"};
  std::uint64_t seed = 1;
};

/// Returns a direction, uniform by solid angle over the hemisphere.
[[nodiscard]] gonio::direction random_direction(std::mt19937_64& generator) {
  std::uniform_real_distribution<double> height(0.0, 1.0), turn(0.0, 2.0 * std::numbers::pi);
  const double z = height(generator), phi = turn(generator), radius = std::sqrt(1.0 - z * z);
  return {radius * std::cos(phi), radius * std::sin(phi), z};
}

/// Returns directions above the horizon, uniform in theta_h, theta_d and phi_d.
[[nodiscard]] gonio::direction_pair random_angles(std::mt19937_64& generator) {
  std::uniform_real_distribution<double> right_angle(0.0, std::numbers::pi / 2.0), half_turn(0.0, std::numbers::pi);
  while (true) {
    const gonio::half_difference angles{right_angle(generator), right_angle(generator), half_turn(generator)};
    const auto [wi, wo] = gonio::to_directions(angles);
    if (wi.z() > 0.0 && wo.z() > 0.0) return {wi, wo};
  }
}

/// Draws the outliers of each channel independently.
[[nodiscard]] gonio::sample_set corrupt_channels(const gonio::sample_set& samples,
                                                 const gonio::measurement_defects& defects, std::uint64_t seed,
                                                 const std::function<gonio::rgb(std::mt19937_64&)>& any_value) {
  gonio::sample_set all = samples;
  for (Eigen::Index channel = 0; channel < 3; ++channel) {
    const gonio::sample_set corrupted = gonio::corrupt(samples, defects, 3 * seed + channel, any_value);
    for (std::size_t i = 0; i < all.size(); ++i) all[i].value[channel] = corrupted[i].value[channel];
  }
  return all;
}

/// Returns the table's values at locations, with outliers. Empty cells hold zero; in the paper's tables they may not.
[[nodiscard]] gonio::sample_set measure(const gonio::brdf_table& truth, std::span<const gonio::location> locations,
                                        double outlier_ratio, outlier_source source, std::uint64_t seed) {
  gonio::sample_set samples;
  for (const gonio::location& at : locations) samples.push_back({at.angles, truth.at(at), 1.0});
  const gonio::measurement_defects defects{.outlier_ratio = outlier_ratio};
  const gonio::valid_cells& valid = truth.cells();
  std::uniform_int_distribution<Eigen::Index> any_cell(0, valid.grid().size() - 1), any_valid(0, valid.size() - 1);
  const auto of_valid = [&](std::mt19937_64& generator) { return gonio::rgb(truth.at(any_valid(generator))); };
  const auto of_all = [&](std::mt19937_64& generator) {
    const Eigen::Index cell = any_cell(generator);
    return valid.contains(cell) ? gonio::rgb(truth.at(valid.representative(cell))) : gonio::rgb(gonio::rgb::Zero());
  };
  const auto of_angles = [&](std::mt19937_64& generator) {
    const auto [wi, wo] = random_angles(generator);
    return gonio::rgb(truth(wi, wo));
  };
  const auto of_directions = [&](std::mt19937_64& generator) {
    const gonio::direction wi = random_direction(generator), wo = random_direction(generator);
    return gonio::rgb(truth(wi, wo));
  };
  switch (source) {
    case outlier_source::all_cells:
      return gonio::corrupt(std::move(samples), defects, seed, of_all);
    case outlier_source::each_channel:
      return corrupt_channels(samples, defects, seed, of_valid);
    case outlier_source::angles:
      return gonio::corrupt(std::move(samples), defects, seed, of_angles);
    case outlier_source::directions:
      return gonio::corrupt(std::move(samples), defects, seed, of_directions);
    default:
      return gonio::corrupt(std::move(samples), defects, seed, of_valid);
  }
}

/// Estimates a table from samples of a case's material, without using that material.
using estimate_function = std::function<gonio::brdf_table(const gonio::sample_set&, const noell_case&)>;

/// Mean Delta E by outlier ratio, one list for each of `judgements`.
using judged_means = std::array<std::vector<double>, judgements.size()>;

/// A row of the table: a method, the variation, and the sources of samples and outliers.
struct gap_setting {
  std::string method, variation;
  named_source outliers;
  sampling samples = sampling::cells;

  [[nodiscard]] std::string name() const { return variation + outliers.name; }
};

/// Measures the materials, reconstructs them and judges the results.
class gap_experiment {
 public:
  gap_experiment(const gap_options& options, const gonio::progress& listener)
      : options_(options),
        results_(options),
        methods_(options.networks, options.environment, options.threads, listener),
        truths_(methods_.materials()),
        delta_e_(truths_.cells,
                 gonio::render::environment_lighting(
                     90, 72, gonio::render::environment_map(gonio::io::read_hdr(options.environment))),
                 36, gonio::sphere_delta_e::middle_grey, options.threads) {}

  /// Returns the locations of the samples, which are a share of the table.
  [[nodiscard]] std::vector<gonio::location> locations(sampling how) const {
    const Eigen::Index count = gonio::share_of(truths_.cells.size(), options_.data_ratio);
    std::vector<gonio::location> chosen;
    if (how == sampling::cells) {
      for (const Eigen::Index cell : gonio::random_cells(truths_.cells, count, options_.seed))
        chosen.push_back(gonio::locate_cell(truths_.cells, cell));
      return chosen;
    }
    std::mt19937_64 generator(options_.seed);
    while (std::ssize(chosen) < count) {
      const auto [wi, wo] = random_angles(generator);
      chosen.push_back(gonio::locate(truths_.cells, gonio::to_half_difference(wi, wo)));
    }
    return chosen;
  }

  /// Returns the combination of the other materials under ln(1 + scale rho), planned for the locations.
  template <gonio::normal_solver Solver>
  [[nodiscard]] estimate_function combination(double scale, const Solver& solver, sampling how) const {
    const papers::planned_decomposition plan{gonio::measured{truths_, scaled_log{scale}, options_.threads},
                                             locations(how), solver, options_.threads};
    return [this, plan](const gonio::sample_set& samples, const noell_case& which) {
      const auto located = gonio::locate_samples(truths_.cells, samples, options_.threads);
      return plan.without({which.material}).reconstruct(located.channels()).tabulate(truths_.cells, options_.threads);
    };
  }

  [[nodiscard]] estimate_function method(const std::string& name) {
    return [this, name](const gonio::sample_set& samples, const noell_case& which) {
      return methods_.estimate(name, which, samples);
    };
  }

  /// Returns the mean errors in each setting. All settings must measure at the same locations.
  [[nodiscard]] std::vector<judged_means> run(const estimate_function& estimate,
                                              std::span<const gap_setting> settings) {
    const std::vector<gonio::location> measured_at = locations(settings.front().samples);
    judged_means none;
    none.fill(std::vector<double>(options_.outlier_ratios.size(), 0.0));
    std::vector<judged_means> means(settings.size(), none);
    // Materials are the outermost loop, because each has its own corrections.
    for (std::size_t m = 0; m < options_.materials.size(); ++m)
      for (std::size_t s = 0; s < settings.size(); ++s)
        for (std::size_t r = 0; r < options_.outlier_ratios.size(); ++r) {
          const noell_case which{
              options_.materials[m], options_.data_ratio, options_.outlier_ratios[r], options_.seed, {}, {}};
          const json& result = results_.once(key_of(settings[s], which), m,
                                             [&] { return judged(estimate, settings[s], which, measured_at); });
          if (result.is_null()) continue;  // left to another process
          for (std::size_t j = 0; j < judgements.size(); ++j)
            means[s][j][r] += result[j].number() / static_cast<double>(options_.materials.size());
        }
    return means;
  }

 private:
  [[nodiscard]] json key_of(const gap_setting& setting, const noell_case& which) const {
    return {setting.method,
            setting.name(),
            which.material,
            which.data_ratio,
            which.outlier_ratio,
            which.seed,
            options_.environment.filename().string()};
  }

  /// Returns the error for each of `judgements`.
  [[nodiscard]] json judged(const estimate_function& estimate, const gap_setting& setting, const noell_case& which,
                            std::span<const gonio::location> measured_at) {
    const std::size_t material = truths_.find(which.material);
    const gonio::brdf_table truth = truths_.table(material);
    const auto samples =
        measure(truth, measured_at, which.outlier_ratio, setting.outliers.source, 1000 * which.seed + material);
    const gonio::brdf_table table = estimate(samples, which);
    json errors = json::array();
    for (const judgement& seen : judgements) errors.push_back(difference(table, truth, seen));
    return errors;
  }

  [[nodiscard]] double difference(const gonio::brdf_table& estimate, const gonio::brdf_table& truth,
                                  const judgement& seen) const {
    const double own = delta_e_.expose(truth, options_.threads).exposure / gonio::sphere_delta_e::middle_grey;
    const double exposure = seen.luminance * (seen.of_white ? 1.0 : own);
    return gonio::sphere_delta_e::difference(delta_e_.look(estimate, exposure, options_.threads),
                                             delta_e_.look(truth, exposure, options_.threads));
  }

  gap_options options_;
  resumable_results results_;
  noell_experiment methods_;
  const gonio::material_set& truths_;  ///< held by methods_
  gonio::sphere_delta_e delta_e_;
};

struct gap_row {
  gap_setting setting;
  judged_means means;
};

[[nodiscard]] std::vector<double> published(const gap_options& options, const std::string& method) {
  std::vector<double> means;
  for (const double ratio : options.outlier_ratios)
    means.push_back(noell_experiment::published(method, options.data_ratio, ratio).value_or(std::nan("")));
  return means;
}

/// Returns the distance of a row from the paper's: the mean |ln(ours / paper's)|, as a factor.
[[nodiscard]] double factor_between(const std::vector<double>& row, const std::vector<double>& paper) {
  double sum = 0.0;
  for (std::size_t i = 0; i < row.size(); ++i) sum += std::abs(std::log(row[i] / paper[i]));
  return std::exp(sum / static_cast<double>(row.size()));
}

void print_rows(const gap_options& options, std::size_t judged, std::span<const gap_row> rows) {
  std::cout << "| method | what is varied |";
  for (const double ratio : options.outlier_ratios) std::cout << " outliers " << fixed(ratio, 1) << " |";
  std::cout << " factor |\n|---|---|";
  for (std::size_t i = 0; i <= options.outlier_ratios.size(); ++i) std::cout << "---|";
  std::cout << '\n';
  const auto print = [](const std::string& method, const std::string& name, const std::vector<double>& means) {
    std::cout << "| " << method << " | " << name << " |";
    for (const double mean : means) std::cout << ' ' << fixed(mean, 2) << " |";
  };
  std::string last;
  for (const gap_row& row : rows) {
    const std::string& method = row.setting.method;
    const std::vector<double> paper = published(options, method);
    if (method != last) {
      print(method, "the paper", paper);
      std::cout << " |\n";
    }
    last = method;
    print(method, row.setting.name(), row.means[judged]);
    std::cout << ' ' << fixed(factor_between(row.means[judged], paper), 2) << " |\n";
  }
}

void run_gap(const gap_options& options) {
  progress_bar bar;
  const gonio::progress listener = bar.listener();
  gap_experiment experiment(options, listener);
  std::vector<gap_row> rows;
  const auto run = [&](const std::string& method, const std::string& name, const estimate_function& estimate,
                       std::span<const named_source> sources, sampling how = sampling::cells) {
    gonio::report(listener, method + ", " + name, 0.0);
    std::vector<gap_setting> settings;
    for (const named_source& source : sources) settings.push_back({method, name, source, how});
    const std::vector<judged_means> means = experiment.run(estimate, settings);
    for (std::size_t s = 0; s < settings.size(); ++s) rows.push_back({settings[s], means[s]});
  };
  // For each method vary the source of outliers, and for the combination also metric and solver.
  const auto combine = [&](double scale, const std::string& metric) {
    run("lc", metric, experiment.combination(scale, gonio::nnls{}, sampling::cells), all_sources);
    run("lc", metric, experiment.combination(scale, gonio::nnls{}, sampling::angles), samples_too, sampling::angles);
  };
  for (const std::string& method : options.methods) {
    if (method == "lc") {
      combine(1.0, "");
      const auto any_sign = experiment.combination(1.0, gonio::least_squares{}, sampling::cells);
      run("lc", "weights of any sign, ", any_sign, std::span(all_sources).first(1));
      for (const double scale : options.scales) combine(scale, "ln(1 + " + fixed(scale, 0) + " rho), ");
    } else if (method == "printed") {
      run(method, "", experiment.method(method), cells_and_angles);
    } else {
      run(method, "", experiment.method(method), all_sources);
      run(method, "", experiment.method(method), samples_too, sampling::angles);
    }
  }
  if (!options.prints()) return;
  bar.wipe();

  std::cout << options.materials.size() << " materials, data ratio " << fixed(options.data_ratio, 2)
            << ": mean Delta E of the sphere under the environment. Factor: exp of the mean |ln(ours / paper's)|.\n";
  for (std::size_t j = 0; j < judgements.size(); ++j) {
    std::cout << "\nExposed so that " << judgements[j].name << ".\n\n";
    print_rows(options, j, rows);
  }
}

}  // namespace

void add_noell_gap(command& app, const team& processes) {
  auto command = app.add_subcommand(
      "noell-gap",
      "Noell et al. 2014, Table 1: what may explain that its linear combination suffers less from outliers");
  const auto options = std::make_shared<gap_options>();
  add_networks_option(command, options->networks);
  command.add_input("--environment", options->environment, "Latitude-longitude image of a natural light (.hdr)")
      .required();
  command.add_option("--methods", options->methods, "Methods: lc, rbf, pull-push, printed")
      .check(check::without(
          [](const std::string& method) {
            constexpr std::array known{"lc", "rbf", "pull-push", "printed"};
            return std::ranges::count(known, method) > 0 ? "" : "there is no method '" + method + "' here";
          },
          "METHOD"))
      .capture_default_str();
  command.add_option("--materials", options->materials, "Names of the materials that are measured")
      .default_str("ten test materials");
  command.add_option("--data", options->data_ratio, "Share of the table that is measured (the data ratio of the paper)")
      .capture_default_str();
  command.add_option("--outliers", options->outlier_ratios, "Shares of the measurements that are outliers")
      .check(check::range(0.0, 1.0))
      .capture_default_str();
  command.add_option("--scales", options->scales, "Scales k of the metric ln(1 + k rho)")
      .check(check::positive_number())
      .capture_default_str();
  command.add_option("--seed", options->seed, "Seed of cells and outliers").capture_default_str();
  add_resumable_options(command, *options);
  do_together(command, processes, options, run_gap);
}

}  // namespace papers
