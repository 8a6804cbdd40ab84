/// gonio-papers design: reconstructs measured materials by priors that have not seen their families. The directions are
/// designed by several criteria, taken from the literature, or chosen from the readings so far.

#include "papers/distribution.hpp"
#include "papers/experiments.hpp"
#include "papers/nielsen2015/nielsen_split.hpp"
#include "papers/our_own/left_out_families.hpp"
#include "tool/files/json.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/core/statistics.hpp>
#include <gonio/design/cell_candidates.hpp>
#include <gonio/design/exhaustive_search.hpp>
#include <gonio/estimate/reconstruction.hpp>
#include <gonio/evaluate/comparison.hpp>
#include <gonio/evaluate/next_measurement.hpp>
#include <gonio/evaluate/perceived_candidates.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/render/environment_map.hpp>
#include <gonio/render/sphere.hpp>

#include <iostream>
#include <map>
#include <memory>
#include <optional>

namespace papers {

namespace {

const std::vector<std::string>& all_methods() {
  static const std::vector<std::string> methods{"published",      "random",   "pursuit",    "information",
                                                "expected-error", "residual", "variance",   "designed",
                                                "exchanged-five", "adaptive", "adaptive-5", "first-five"};
  return methods;
}

struct design_experiment_options : left_out_options {
  std::filesystem::path folder, environment;
  std::vector<Eigen::Index> counts{5, 8, 10, 16, 20};
  std::vector<std::string> methods = all_methods();
  Eigen::Index sets = 10;  ///< number of random sets of directions
  Eigen::Index first = 5;  ///< number of designed directions that begin an adaptive scan
  double noise = 0.0;
};

using estimator_type = gonio::reconstruction<gonio::log_relative>;
using chooser_type = gonio::measurement_chooser<gonio::log_relative>;
using directions = std::vector<gonio::half_difference>;

/// The estimator and the directions for the materials of one family.
struct family_setup {
  estimator_type estimator;
  chooser_type chooser;
  std::map<std::string, directions> designed = {};  ///< by method and count
};

/// Returns the directions of cells, in the order of measurement.
directions of_cells(const gonio::design::point_geometry& points, std::span<const Eigen::Index> cells) {
  directions all;
  for (const Eigen::Index cell : cells) {
    const auto [wi, wo] = points.centre(cell);
    all.push_back(gonio::to_half_difference(wi, wo));
  }
  return all;
}

/// Chooses by orthogonal matching pursuit the candidates whose values explain those of all cells: Miandji,
/// Tongbuasirilai, Hajisharif, Kavoosighafi and Unger 2024 (arXiv 2401.07283). The covariance of a prior replaces the
/// dictionary's Gram matrix.
std::vector<Eigen::Index> pursue(const gonio::design::point_geometry& points, const Eigen::MatrixXd& covariance,
                                 Eigen::Index count) {
  const Eigen::VectorXd lengths = covariance.diagonal();
  gonio::design::candidate_posterior rest{{}, covariance};
  std::vector<Eigen::Index> chosen;
  while (std::ssize(chosen) < count) {
    Eigen::Index best = -1;
    double most = -1.0;
    for (Eigen::Index i = 0; i < points.size(); ++i) {
      if (!points.allows(i) || std::ranges::find(chosen, i) != chosen.end()) continue;
      const double explained = rest.covariance.col(i).squaredNorm() / lengths[i];
      if (explained > most) {
        most = explained;
        best = i;
      }
    }
    chosen.push_back(best);
    rest.add(best, 1e-6 * lengths[best]);
  }
  return chosen;
}

/// Repeatedly chooses the candidate with the largest variance over error variance: the most information about a
/// Gaussian process.
std::vector<Eigen::Index> most_information(const gonio::design::sequential_design<gonio::log_relative>& cells,
                                           Eigen::Index count) {
  gonio::design::candidate_posterior known = cells.prior();
  std::vector<Eigen::Index> chosen;
  while (std::ssize(chosen) < count) {
    Eigen::Index best = -1;
    double most = -1.0;
    for (Eigen::Index i = 0; i < cells.geometry().size(); ++i) {
      const double gained = known.covariance(i, i) / cells.error_variances()[i];
      if (!cells.geometry().allows(i) || gained <= most) continue;
      most = gained;
      best = i;
    }
    chosen.push_back(best);
    known.add(best, cells.error_variances()[best]);
  }
  return chosen;
}

/// The image of a sphere in a measured environment as a display shows it: white at the 99th percentile.
class displayed_sphere {
 public:
  displayed_sphere(const gonio::valid_cells& cells, const std::filesystem::path& environment,
                   gonio::thread_count threads)
      : sphere_(cells,
                gonio::render::environment_lighting<gonio::render::environment_map>(
                    90, 72, gonio::render::environment_map(gonio::io::read_hdr(environment))),
                36, threads) {}

  /// Returns the peak signal-to-noise ratio of sRGB values over the sphere's points, in dB.
  [[nodiscard]] double psnr(const gonio::brdf_table& estimate, const gonio::brdf_table& truth) const {
    const gonio::render::sphere_colours of_truth = sphere_.apply(truth), of_estimate = sphere_.apply(estimate);
    std::vector<double> all(of_truth.data(), of_truth.data() + of_truth.size());
    const double white = gonio::quantile(all, 0.99);
    double squares = 0.0;
    for (Eigen::Index i = 0; i < of_truth.size(); ++i) {
      const auto shown = [&](double linear) { return gonio::encode_srgb(std::clamp(linear / white, 0.0, 1.0)); };
      squares += std::pow(shown(of_truth.data()[i]) - shown(of_estimate.data()[i]), 2);
    }
    return -10.0 * std::log10(std::max(squares / static_cast<double>(of_truth.size()), 1e-12));
  }

 private:
  gonio::render::sphere_operator sphere_;
};

class design_experiment : left_out_experiment {
 public:
  design_experiment(const design_experiment_options& given, progress_bar& bar)
      : left_out_experiment(given, bar), given_(given) {
    if (!given.environment.empty()) sphere_.emplace(library_.cells(), given.environment, given.threads);
  }

  /// Returns a row for each number of samples and method, with the errors of each material.
  [[nodiscard]] json run() {
    const std::vector<judged_material> materials = measured_materials(given_.materials, library_);
    std::map<std::pair<Eigen::Index, std::string>, json> found;
    for (const judged_material& material : materials)
      for (const std::string& method : given_.methods) {
        json counts = json::array();
        for (const Eigen::Index count : given_.counts) counts.push_back(count);
        const json key{"design",     method,      material.name,          given_.components, counts,
                       given_.noise, given_.sets, given_.folder.string(), given_.first};
        const json& by_count =
            once(key, material.turn, material.name + " " + method, [&] { return errors_by_count(material, method); });
        if (by_count.is_null()) continue;  // left to another process
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

  /// Returns the setup for the materials of a family, learned without this family. Keeps only the last setup, because
  /// materials of one family follow one another.
  family_setup& setup_without(const std::string& family) {
    if (setup_ && family_ == family) return *setup_;
    setup_.reset();
    const estimator_type estimator{
        library_.prior_without(family, given_.components), {.noise = given_.noise}, given_.threads};
    chooser_type chooser{estimator, gonio::design::usual_apparatus(), gonio::design::default_candidates(),
                         given_.threads};
    setup_.emplace(family_setup{estimator, std::move(chooser)});
    family_ = family;
    return *setup_;
  }

  /// Returns the first `count` directions for a family by a method.
  directions designed(const std::string& method, Eigen::Index count, family_setup& with) const {
    const bool depends_on_count = method == "exchange";
    const std::string key = depends_on_count ? method + std::to_string(count) : method;
    const auto found = with.designed.find(key);
    if (found == with.designed.end()) {
      with.designed[key] = searched(method, depends_on_count ? count : most(), with);
      return designed(method, count, with);
    }
    return {found->second.begin(), found->second.begin() + count};
  }

  directions searched(const std::string& method, Eigen::Index count, const family_setup& with) const {
    const auto& cells = with.chooser.candidates();
    if (method == "information") return of_cells(cells.geometry(), most_information(cells, count));
    if (method == "pursuit")
      return of_cells(cells.geometry(), pursue(cells.geometry(), cells.prior().covariance, count));
    if (method == "expected-error") {
      const gonio::design::cell_candidates every(
          with.estimator.prior(), gonio::design::expected_error(with.estimator.prior(), {.leave_out = true}),
          gonio::design::usual_apparatus().constraint, given_.threads);
      return of_cells(every.geometry(), gonio::design::grow_greedily(every, count).candidates);
    }
    gonio::perceived_options options;
    if (method == "residual") options.variance_share = 0.0;
    if (method == "variance") options.variance_share = 1.0;
    if (method == "worst-case") options.power = 8.0;
    const gonio::perceived_candidates seen(cells, options, given_.threads);
    gonio::design::capture_plan plan =
        gonio::design::grow_greedily(seen, method == "exchanged-five" ? given_.first : count);
    if (method.starts_with("exchange")) plan = gonio::design::exchange(seen, std::move(plan));
    plan = gonio::design::grow_greedily(seen, count, std::move(plan));
    return of_cells(seen.geometry(), plan.candidates);
  }

  json errors_by_count(const judged_material& material, const std::string& method) {
    family_setup& with = setup_without(material.family);
    if (method.starts_with("adaptive") || method == "first-five") return followed(material, method, with);
    json all = json::object();
    for (const Eigen::Index count : given_.counts) {
      std::vector<directions> sets;
      if (method == "random") {
        for (const directions& set : random_sampling(count, given_.sets).sets) sets.push_back(set);
      } else if (is_designed(method)) {
        sets.push_back(designed(method, count, with));
      } else if (const auto points = written_points(given_.folder, method, count)) {
        sets.push_back(*points);
      }
      if (sets.empty()) continue;
      std::map<std::string, double> means;
      for (const directions& set : sets) {
        const json errors = errors_of(material, measured(material, set), with);
        for (const auto& [key, value] : errors.items()) means[key] += value.number() / static_cast<double>(sets.size());
      }
      json& errors = all[std::to_string(count)] = json::object();
      for (const auto& [key, value] : means) errors[key] = value;
    }
    return all;
  }

  static bool is_designed(const std::string& method) {
    static const std::vector<std::string> searched{"pursuit",  "information", "expected-error",
                                                   "residual", "variance",    "worst-case",
                                                   "designed", "exchange",    "exchanged-five"};
    return std::ranges::find(searched, method) != searched.end();
  }

  [[nodiscard]] gonio::sample_set measured(const judged_material& material, const directions& set) const {
    return measure(material.measured, set, given_.noise, material.number);
  }

  /// Begins with exchanged directions. Chooses the next ones from all readings so far; for "first-five", from the first
  /// readings alone.
  json followed(const judged_material& material, const std::string& method, family_setup& with) {
    json all = json::object();
    directions so_far = designed("exchanged-five", given_.first, with);
    while (true) {
      const gonio::sample_set samples = measured(material, so_far);
      const Eigen::Index count = std::ssize(so_far);
      if (std::ranges::find(given_.counts, count) != given_.counts.end())
        all[std::to_string(count)] = errors_of(material, samples, with);
      if (count >= most()) return all;
      const Eigen::Index batch = method == "adaptive" ? 1 : method == "adaptive-5" ? 5 : most() - count;
      for (const gonio::next_measurement& next : with.chooser.choose(samples, std::min(batch, most() - count)))
        so_far.push_back(next.angles);
      // A count that ends within a batch uses the first directions of that batch.
      for (const Eigen::Index between : given_.counts)
        if (batch > 1 && between > count && between < std::ssize(so_far))
          all[std::to_string(between)] =
              errors_of(material, measured(material, {so_far.begin(), so_far.begin() + between}), with);
    }
  }

  json errors_of(const judged_material& material, const gonio::sample_set& samples, const family_setup& with) const {
    const gonio::brdf_table table = with.estimator.fit(samples).tabulate(library_.cells());
    const gonio::comparison errors = compare(table, material);
    json all{{"mapped_rms", errors.mapped_rms.mean()},
             {"delta_e_env", errors.delta_e_env},
             {"delta_e_lights", errors.delta_e_lights}};
    if (sphere_) all["psnr"] = sphere_->psnr(table, material.truth);
    return all;
  }

  const design_experiment_options& given_;
  std::optional<displayed_sphere> sphere_;
  std::string family_;
  std::optional<family_setup> setup_;
};

std::string worst_of(const json& row) {
  std::string worst;
  double most = -1.0;
  for (const auto& [name, errors] : row["materials"].items())
    if (errors["delta_e_env"].number() > most) {
      most = errors["delta_e_env"].number();
      worst = name;
    }
  return worst + " " + fixed(most, 1);
}

/// Returns each material's errors with the criterion that is best for all other families. The difference from the best
/// criterion is the cost of a choice made without the material.
json chosen_by_others(const json& rows, double samples) {
  const std::vector<std::string> criteria{"pursuit",  "information", "expected-error", "residual",
                                          "variance", "worst-case",  "designed",       "exchanged-five"};
  std::map<std::string, std::map<std::string, json>> by_method;
  for (const json& row : rows.elements())
    if (row["samples"].number() == samples && std::ranges::find(criteria, row["method"].text()) != criteria.end())
      for (const auto& [name, errors] : row["materials"].items()) by_method[row["method"].text()][name] = errors;
  json chosen = json::object();
  if (by_method.empty()) return chosen;
  for (const auto& [name, unused] : by_method.begin()->second) {
    std::string best;
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [method, materials] : by_method) {
      double sum = 0.0;
      for (const auto& [other, errors] : materials)
        if (gonio::material_family(other) != gonio::material_family(name))
          sum += errors["delta_e_env"].number() + errors["delta_e_lights"].number();
      if (sum >= least) continue;
      least = sum;
      best = method;
    }
    chosen[name] = by_method[best][name];
  }
  return chosen;
}

void print(const json& rows) {
  std::cout
      << "Means (medians) over " << rows[0]["materials"].size() << " materials.\n\n"
      << "| samples | directions | Delta E env | Delta E lights | PSNR in dB | mapped rms | worst: Delta E env |\n"
         "|---|---|---|---|---|---|---|\n";
  const auto print_row = [](const json& row) {
    std::map<std::string, std::vector<double>> values;
    for (const auto& [name, errors] : row["materials"].items())
      for (const auto& [key, value] : errors.items()) values[key].push_back(value.number());
    const auto mean_and_median = [&](const char* key, int digits) -> std::string {
      if (!values.contains(key)) return "";
      const distribution found(values[key]);
      return fixed(found.mean, digits) + " (" + fixed(found.median, digits) + ")";
    };
    std::cout << "| " << fixed(row["samples"].number(), 0) << " | " << row["method"].text() << " | "
              << mean_and_median("delta_e_env", 2) << " | " << mean_and_median("delta_e_lights", 2) << " | "
              << mean_and_median("psnr", 1) << " | " << mean_and_median("mapped_rms", 3) << " | " << worst_of(row)
              << " |\n";
  };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    print_row(rows[i]);
    const double samples = rows[i]["samples"].number();
    if (i + 1 < rows.size() && rows[i + 1]["samples"].number() == samples) continue;
    const json others = chosen_by_others(rows, samples);
    if (others.size() > 0)
      print_row({{"samples", samples}, {"method", "criterion chosen by the other families"}, {"materials", others}});
  }
}

}  // namespace

void add_design_experiment(command& app, const team& processes) {
  auto command = app.add_subcommand(
      "design", "Reconstruct materials from designed directions, and from directions chosen by the readings so far");
  const auto options = std::make_shared<design_experiment_options>();
  options->folder = shipped_directions();
  add_left_out_options(command, *options);
  command.add_input_folder("--directions", options->folder, {".csv"}, "Folder of sets of directions");
  command.add_input("--environment", options->environment, "Light probe (.hdr): compares spheres in its light, too");
  command.add_option("-n,--counts", options->counts, "Numbers of samples").capture_default_str();
  command.add_option("--noise", options->noise, "Relative noise of the samples").capture_default_str();
  command
      .add_option("--first", options->first,
                  "Number of designed and exchanged directions with which an adaptive scan begins")
      .check(check::positive_number())
      .capture_default_str();
  command.add_option("--sets", options->sets, "Number of random sets of each size").check(check::positive_number());
  command
      .add_option("--methods", options->methods,
                  "Methods. designed: greedy; pursuit (Miandji et al. 2024), information, expected-error, residual, "
                  "variance, worst-case: greedy with another criterion; exchange: designed, then exchanged; "
                  "exchanged-five: only the first (--first) are exchanged; adaptive: the directions after the first "
                  "are chosen by the readings so far, one by one; adaptive-5: in batches; first-five: all of them by "
                  "the first readings; random; or a set of the folder: published for point-20-published.csv")
      .capture_default_str();
  do_together(command, processes, options, [](const auto& given) {
    if (std::ranges::min(given.counts) < 1) gonio::refuse("--counts needs numbers of at least 1");
    if (given.first > std::ranges::max(given.counts)) gonio::refuse("--first must not exceed the largest of --counts");
    run_and_print<design_experiment>(given, print);
  });
}

}  // namespace papers
