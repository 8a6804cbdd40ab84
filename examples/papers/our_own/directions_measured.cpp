/// gonio-papers directions-measured: real measurements, reconstructed from few directions that were optimised for a
/// database.

#include "papers/distribution.hpp"
#include "papers/experiments.hpp"
#include "papers/material_result.hpp"
#include "papers/mean_errors.hpp"
#include "papers/networks_option.hpp"
#include "papers/nielsen2015/nielsen_split.hpp"
#include "papers/our_own/scattered_errors.hpp"
#include "papers/resumable_results.hpp"
#include "tool/files/json.hpp"
#include "tool/files/measurement_files.hpp"
#include "tool/options/solver_choice.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/basis/pca.hpp>
#include <gonio/core/random.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/estimate/eta_of_noise.hpp>
#include <gonio/evaluate/appearance_metric.hpp>
#include <gonio/evaluate/comparison.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/io/materials/merl_directory.hpp>
#include <gonio/io/materials/merl_gzip.hpp>
#include <gonio/io/materials/networks.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <iostream>
#include <limits>
#include <memory>
#include <optional>

namespace papers {

namespace {

struct directions_options : resumable_options {
  std::filesystem::path networks, tables, folder = shipped_directions();
  std::vector<std::filesystem::path> samples;
  std::vector<std::string> sets{"published", "expected-error", "perceived", "random"};
  std::vector<Eigen::Index> counts{1, 2, 5, 10, 20};
  std::string eta = "auto";
  std::uint64_t seed = 0;
  Eigen::Index repetitions = 5;
  bool print_json = false;
};

/// The prior on some cells, and its appearance metric.
struct benchmark_setup {
  gonio::log_relative_pca prior;
  gonio::appearance_metric appearance;
};

benchmark_setup open_benchmark_setup(const directions_options& given, const gonio::valid_cells& cells,
                                     const gonio::progress& listener) {
  return {learn_all_components(gonio::io::read_networks(given.networks), cells, given.threads, listener),
          gonio::appearance_metric(cells, 36, given.threads)};
}

// ---- tables: errors over all cells ---------------------------------------------------------------------------------

/// Returns the cells to measure, one list per draw of the set.
std::vector<std::vector<Eigen::Index>> cells_of(const directions_options& given, const gonio::valid_cells& cells,
                                                const std::string& set, std::size_t count) {
  std::vector<std::vector<Eigen::Index>> drawn;
  if (set == "random") {
    for (Eigen::Index r = 0; r < given.repetitions; ++r)
      drawn.push_back(gonio::random_cells(cells, count, given.seed + r));
  } else if (const auto directions = written_points(given.folder, set, count)) {
    drawn.push_back(gonio::cells_at(cells, *directions));
  }
  return drawn;
}

double eta_for(const directions_options& given, const gonio::log_relative_pca& prior,
               const gonio::sample_set& samples) {
  return given.eta == "auto" ? gonio::eta_of_unknown_noise(prior, samples, 0.3, given.threads)
                             : number_of_eta(given.eta);
}

json judge_table(const directions_options& given, const benchmark_setup& setup, const std::string& name,
                 const gonio::brdf_table& truth, const std::vector<std::vector<Eigen::Index>>& drawn) {
  std::vector<material_result> results;
  double mean_eta = 0.0;
  for (const auto& cells : drawn) {
    const gonio::sample_set samples = gonio::sample_table(truth, cells);
    const double eta = eta_for(given, setup.prior, samples);
    mean_eta += eta / static_cast<double>(drawn.size());
    const auto estimate =
        gonio::decomposition{setup.prior, gonio::tikhonov{eta}}.fit(samples).tabulate(truth.cells(), given.threads);
    results.push_back({name, gonio::compare(estimate, truth, setup.prior.metric(), setup.appearance, given.threads)});
  }
  json means = mean_errors(results);
  means["eta"] = mean_eta;
  return means;
}

// ---- scattered measurements: errors on those that were not used ----------------------------------------------------

/// Returns the distance of two pairs of directions: the larger of the angles between the lights and between the
/// viewers. A rotation about the normal, which does not change an isotropic material, first brings the pairs closest.
double angle_between(const gonio::direction_pair& from, const gonio::direction_pair& to) {
  // The rotation maximises the sum of the cosines, A cos phi + B sin phi + C.
  const auto along = [](const gonio::direction& a, const gonio::direction& b) { return a.x() * b.x() + a.y() * b.y(); };
  const auto across = [](const gonio::direction& a, const gonio::direction& b) {
    return a.x() * b.y() - a.y() * b.x();
  };
  const double phi =
      std::atan2(across(from.wi, to.wi) + across(from.wo, to.wo), along(from.wi, to.wi) + along(from.wo, to.wo));
  const auto off = [&](const gonio::direction& a, const gonio::direction& b) {
    const gonio::direction turned = gonio::turned_about_normal(a, phi);
    return std::atan2(turned.cross(b).norm(), turned.dot(b));
  };
  return std::max(off(from.wi, to.wi), off(from.wo, to.wo));
}

/// The measurements that replace the wanted directions, with their distances in radians.
struct stand_ins {
  std::vector<Eigen::Index> samples;
  std::vector<double> distances;
};

/// Finds the nearest measurement to each direction. Light and viewer may be exchanged; no measurement is used twice.
stand_ins nearest_measured(const gonio::sample_set& all, std::span<const gonio::half_difference> directions) {
  stand_ins found;
  for (const gonio::half_difference& angles : directions) {
    const gonio::direction_pair wanted = gonio::to_directions(angles);
    std::size_t nearest = 0;
    double distance = std::numeric_limits<double>::infinity();
    for (std::size_t s = 0; s < all.size(); ++s) {
      if (std::ranges::find(found.samples, s) != found.samples.end()) continue;
      const auto [wi, wo] = all[s].directions.pair();
      const double here = std::min(angle_between(wanted, {wi, wo}), angle_between(wanted, {wo, wi}));
      if (here < distance) {
        nearest = s;
        distance = here;
      }
    }
    found.samples.push_back(nearest);
    found.distances.push_back(distance);
  }
  return found;
}

/// Returns the measurements to use, one list per draw of the set. Random measurements have distance 0.
std::vector<stand_ins> samples_of(const directions_options& given, const gonio::sample_set& all, const std::string& set,
                                  std::size_t count) {
  std::vector<stand_ins> drawn;
  if (set == "random") {
    for (Eigen::Index r = 0; r < given.repetitions; ++r)
      drawn.push_back({gonio::random_choice(all.size(), count, given.seed + r), std::vector<double>(count, 0.0)});
  } else if (const auto directions = written_points(given.folder, set, count)) {
    drawn.push_back(nearest_measured(all, *directions));
  }
  return drawn;
}

json judge_samples(const directions_options& given, const benchmark_setup& setup, const gonio::sample_set& all,
                   const std::vector<stand_ins>& drawn) {
  const auto times = static_cast<double>(drawn.size());
  double in_logarithms = 0.0, weighted = 0.0, distance = 0.0, farthest = 0.0, mean_eta = 0.0;
  for (const stand_ins& used : drawn) {
    gonio::sample_set some, others;
    for (std::size_t s = 0; s < all.size(); ++s)
      (std::ranges::find(used.samples, s) != used.samples.end() ? some : others).push_back(all[s]);
    const double eta = eta_for(given, setup.prior, some);
    mean_eta += eta / times;
    const auto fit = gonio::decomposition{setup.prior, gonio::tikhonov{eta}}.fit(some);
    logarithmic_error log_error;
    cosine_weighted_error cosine_error;
    for (const gonio::sample& other : others) {
      const gonio::direction_pair pair = other.directions.pair();
      const gonio::rgb estimate = fit(pair.wi, pair.wo);
      log_error.add(estimate, other.value);
      cosine_error.add(estimate, other.value, pair);
    }
    in_logarithms += log_error.value() / times;
    weighted += cosine_error.value() / times;
    distance += distribution(used.distances).mean / times;
    farthest = std::max(farthest, distribution(used.distances).worst);
  }
  return {{"log_error", in_logarithms},
          {"cosine_error", weighted},
          {"eta", mean_eta},
          {"degrees_mean", gonio::degrees(distance)},
          {"degrees_worst", gonio::degrees(farthest)},
          {"judged_by", all.size() - drawn.front().samples.size()}};
}

// ---- the experiment ------------------------------------------------------------------------------------------------

/// Computes the results that do not exist yet, and learns the prior only if needed.
class experiment {
 public:
  experiment(const directions_options& given, progress_bar& bar) : given_(given), bar_(bar), results_(given) {}

  [[nodiscard]] json tables() {
    json rows = json::array();
    if (given_.tables.empty()) return rows;
    const auto files = gonio::io::list_merl_directory(given_.tables);
    for (const auto& [name, path] : files) {
      std::optional<gonio::brdf_table> truth;
      each_set(name, turn_++, rows, [&](const std::string& set, std::size_t count) -> json {
        if (!truth) truth.emplace(gonio::io::read_merl_any(path));
        const auto drawn = cells_of(given_, truth->cells(), set, count);
        if (drawn.empty()) return {};
        return judge_table(given_, setup_for(truth->cells()), name, *truth, drawn);
      });
    }
    return rows;
  }

  [[nodiscard]] json scattered() {
    json rows = json::array();
    for (const std::filesystem::path& file : given_.samples) {
      const gonio::sample_set all = read_measurements(file);
      each_set(file.stem().string(), turn_++, rows, [&](const std::string& set, std::size_t count) -> json {
        if (count >= all.size())
          gonio::refuse(file.string() + ": no sample is left for the comparison after fitting " +
                        std::to_string(count));
        const auto drawn = samples_of(given_, all, set, count);
        if (drawn.empty()) return {};
        return judge_samples(given_, setup_for(gonio::valid_cells()), all, drawn);
      });
    }
    return rows;
  }

 private:
  /// Adds a row for each number of directions and each set that exists. `judge` returns nothing for a set that does not
  /// exist.
  template <class Judge>
  void each_set(const std::string& name, std::size_t turn, json& rows, Judge&& judge) {
    for (const Eigen::Index count : given_.counts)
      for (const std::string& set : given_.sets) {
        const json key{name, count, set, given_.eta, given_.seed, given_.repetitions};
        const json& result = results_.once(key, turn, [&] {
          bar_.draw(name, 0.0);
          return judge(set, count);
        });
        if (!result.is_null()) rows.push_back({{"material", name}, {"count", count}, {"set", set}, {"result", result}});
      }
  }

  const benchmark_setup& setup_for(const gonio::valid_cells& cells) {
    if (!setup_ || !(setup_->prior.cells() == cells)) {
      setup_.reset();  // two would take twice the memory
      setup_.emplace(open_benchmark_setup(given_, cells, bar_.listener()));
    }
    return *setup_;
  }

  const directions_options& given_;
  progress_bar& bar_;
  resumable_results results_;
  std::size_t turn_ = 0;                  ///< one per material
  std::optional<benchmark_setup> setup_;  // on the cells of the last table, which the next table often shares
};

/// Returns the means over materials for each number and set, in the order of the rows.
json means_of(const json& rows) {
  std::vector<json> means;
  for (const json& row : rows.elements()) {
    auto found = std::ranges::find_if(
        means, [&](const json& mean) { return mean["count"] == row["count"] && mean["set"] == row["set"]; });
    if (found == means.end()) {
      means.push_back({{"count", row["count"]}, {"set", row["set"]}, {"materials", 0}, {"result", json::object()}});
      found = means.end() - 1;
    }
    (*found)["materials"] = (*found)["materials"].number() + 1.0;
    for (const auto& [key, value] : row["result"].items()) {
      json& sum = (*found)["result"][key];
      sum = (sum.is_null() ? 0.0 : sum.number()) + value.number();
    }
  }
  for (json& mean : means)
    for (auto& [key, value] : mean["result"].items()) value = value.number() / mean["materials"].number();
  return means;
}

struct column {
  const char *key, *title;
  int digits;
};

void print_rows(const json& rows, std::span<const column> columns) {
  const json means = means_of(rows);
  std::cout << "| material | n | chosen by |";
  for (const column& c : columns) std::cout << ' ' << c.title << " |";
  std::cout << "\n|---|---|---|" << [&] {
    std::string line;
    for (std::size_t i = 0; i < columns.size(); ++i) line += "---|";
    return line;
  }() << '\n';
  const auto print_row = [&](const std::string& name, const json& row) {
    std::cout << "| " << name << " | " << row["count"] << " | " << row["set"].text() << " |";
    for (const column& c : columns) std::cout << ' ' << fixed(row["result"][c.key].number(), c.digits) << " |";
    std::cout << '\n';
  };
  for (const json& row : means.elements()) print_row("mean of " + fixed(row["materials"], 0), row);
  for (const json& row : rows.elements()) print_row(row["material"].text(), row);
}

void print(const directions_options& given, const json& tables, const json& scattered) {
  std::cout << "eta = " << given.eta << ", random: means of " << given.repetitions << " sets.\n";
  if (!tables.empty()) {
    static constexpr std::array columns{column{"mapped_rms", "mapped rms", 3}, column{"delta_e_env", "Delta E env", 2},
                                        column{"delta_e_lights", "Delta E lights", 2}, column{"peak_ratio", "peak", 2},
                                        column{"eta", "eta", 2}};
    std::cout << "\nTables, judged as a whole:\n\n";
    print_rows(tables, columns);
  }
  if (!scattered.empty()) {
    static constexpr std::array columns{column{"log_error", "rms of ln(f + 0.001)", 3},
                                        column{"cosine_error", "cosine-weighted relative error", 3},
                                        column{"degrees_mean", "degrees off, mean", 1},
                                        column{"degrees_worst", "degrees off, worst", 1}, column{"eta", "eta", 2}};
    std::cout << "\nScattered measurements, from the nearest ones to the directions, judged on all others:\n\n";
    print_rows(scattered, columns);
  }
}

/// Refuses a set that exists for none of the numbers.
void require_sets(const directions_options& given) {
  for (const std::string& set : given.sets)
    if (set != "random" && std::ranges::none_of(given.counts, [&](std::size_t count) {
          return written_points(given.folder, set, count).has_value();
        }))
      gonio::refuse("--sets: there is no set '" + set + "' of these numbers, no " +
                    (given.folder / points_file(set, given.counts.front())).string());
}

void run(const directions_options& given) {
  if (given.tables.empty() && given.samples.empty())
    gonio::refuse("there is nothing to reconstruct: give --tables or --samples");
  require_sets(given);
  progress_bar bar;
  experiment work(given, bar);
  const json tables = work.tables(), scattered = work.scattered();
  if (!given.prints()) return;
  bar.wipe();
  if (given.print_json)
    std::cout << json{{"tables", tables}, {"scattered", scattered}}.dump(2) << '\n';
  else
    print(given, tables, scattered);
}

}  // namespace

void add_directions_measured(command& app, const team& processes) {
  auto command = app.add_subcommand(
      "directions-measured", "Reconstruct real measurements from the directions that are the best for a database");
  const auto options = std::make_shared<directions_options>();
  add_networks_option(command, options->networks);
  command.add_input_folder("--tables", options->tables, {".binary", ".gz"},
                           "Folder of MERL tables (.binary or .binary.gz)");
  command.add_input("--samples", options->samples,
                    "Measurements in any directions (.csv, or .brdf in Cornell's text format)");
  command.add_input_folder("--directions", options->folder, {".csv"},
                           "Folder of sets, as `gonio-papers directions --write` writes them");
  command
      .add_option("--sets", options->sets,
                  "published, random, or a set of the folder: perceived for point-20-perceived.csv")
      .capture_default_str();
  add_counts_option(command, options->counts);
  command.add_option("--eta", options->eta, "Tikhonov's penalty: a number, or auto, as `gonio reconstruct` chooses it")
      .capture_default_str();
  command.add_option("--seed", options->seed, "Seed of the first random set").capture_default_str();
  command.add_option("--repetitions", options->repetitions, "Number of random sets of each size")
      .check(check::positive_number())
      .capture_default_str();
  command.add_flag("--json", options->print_json, "Print as JSON");
  add_resumable_options(command, *options);
  do_together(command, processes, options, run);
}

}  // namespace papers
