#include "papers/noell2014/noell_experiment.hpp"

#include "papers/noell2014/noell_measures.hpp"
#include "papers/noell2014/planned_decomposition.hpp"
#include "tool/files/json.hpp"
#include "tool/options/scattered_samples.hpp"
#include <gonio/basis/rbf.hpp>
#include <gonio/estimate/basis_equations.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/interpolate/pull_push.hpp>
#include <gonio/io/materials/networks.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/metric/lin.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/metric/root.hpp>
#include <gonio/robust/robust_reconstruction.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <algorithm>
#include <chrono>
#include <map>
#include <random>
#include <tuple>

namespace papers {

namespace {

/// "our-lin" is the method "our" under the metric "lin"; "gamma-3" has a number in place of the metric.
struct method_name {
  std::string method, metric = "log";
  double gamma = 0.0;
};

[[nodiscard]] std::optional<method_name> read_method(const std::string& text) {
  const auto dash = text.rfind('-');
  const auto has_metric = [](const std::string& name) {
    return name == "our" || name == "printed" || name == "lc" || name == "rbf";
  };
  if (text == "pull-push" || text == "scattered" || has_metric(text)) return method_name{text};
  const std::string head = text.substr(0, dash), tail = dash == std::string::npos ? "" : text.substr(dash + 1);
  if (head == "gamma") {
    double gamma = 0.0;
    if (!gonio::io::read_number(tail, gamma) && gamma >= 0.0) return method_name{head, "log", gamma};
  }
  if (has_metric(head) && (tail == "lin" || tail == "root" || tail == "log")) return method_name{head, tail};
  return std::nullopt;
}

/// Returns the names to leave out for a material: none if its name is empty.
[[nodiscard]] std::vector<std::string> names_of(const std::string& material) {
  return material.empty() ? std::vector<std::string>() : std::vector{material};
}

/// Returns the names that a case leaves out: its material, and all materials that its basis does not draw. Smaller
/// bases are subsets of the larger ones with the same seed.
[[nodiscard]] std::vector<std::string> left_out(const noell_case& which, const std::vector<std::string>& names) {
  std::vector<std::string> out = names_of(which.material);
  if (!which.basis) return out;
  std::vector<std::string> others = names;
  std::erase(others, which.material);
  if (*which.basis > std::ssize(others))
    gonio::refuse({"--basis ", *which.basis, " needs as many other materials, there are ", others.size()});
  std::mt19937_64 generator(which.seed);
  std::ranges::shuffle(others, generator);
  out.insert(out.end(), others.begin() + *which.basis, others.end());
  return out;
}

/// Identifies the measurement of a case.
using case_key = std::tuple<std::string, double, double, std::uint64_t>;
[[nodiscard]] case_key key_of(const noell_case& which) {
  return {which.material, which.data_ratio, which.outlier_ratio, which.seed};
}

template <class Value>
class made_on_demand {
 public:
  template <class Make>
  const Value& get(Make&& make) {
    if (!value_) value_.emplace(make());
    return *value_;
  }

 private:
  std::optional<Value> value_;
};

/// Materials under a metric, and their combinations at the cells of each share of data and seed. These cells are the
/// same for all materials.
template <class Metric>
struct combinations_under {
  made_on_demand<gonio::measured<Metric>> materials;
  made_on_demand<gonio::rbf<Metric>> radial_functions;
  std::map<case_key, Eigen::MatrixXd> radial_weights;  // computed by solve_radial
  std::map<std::pair<double, std::uint64_t>, papers::planned_decomposition<Metric>> plans;
};

}  // namespace

/// Keeps the system solvable when there are few samples.
const gonio::tikhonov radial_penalty{1e-6};

struct noell_experiment::parts {
  gonio::thread_count threads;
  gonio::material_set truths;
  noell_measures measures;
  std::tuple<combinations_under<gonio::lin>, combinations_under<gonio::root>, combinations_under<gonio::log>>
      combinations;
  /// The corrections of all materials, and the corrections without the materials that were last left out. Many
  /// consecutive runs share them.
  struct correction_cache {
    made_on_demand<gonio::correction> all, fewer;
    std::vector<std::string> left_out;
  };
  correction_cache corrections, printed_corrections;

  template <class Metric>
  const gonio::measured<Metric>& materials(const Metric& metric) {
    return std::get<combinations_under<Metric>>(combinations).materials.get([&] {
      return gonio::measured{truths, metric, threads};
    });
  }

  template <class Metric>
  const gonio::rbf<Metric>& radial_functions(const Metric& metric) {
    return std::get<combinations_under<Metric>>(combinations).radial_functions.get([&] {
      return gonio::rbf{truths.cells, metric};
    });
  }

  /// Solves the weights of radial basis functions for cases measured at the same cells, which share the normal
  /// equations.
  template <class Metric>
  void solve_radial(const Metric& metric, std::span<const noell_case> cases) {
    gonio::located_samples all = gonio::locate_samples(truths.cells, measure(cases.front()), threads);
    all.values.resize(all.size(), 3 * std::ssize(cases));
    for (std::size_t i = 0; i < cases.size(); ++i)
      all.values.middleCols(3 * i, 3) = gonio::locate_samples(truths.cells, measure(cases[i]), threads).values;
    const gonio::basis_equations equations(radial_functions(metric), std::move(all), threads);
    const Eigen::MatrixXd weights = equations.solve(radial_penalty).weights;
    auto& known = std::get<combinations_under<Metric>>(combinations).radial_weights;
    for (std::size_t i = 0; i < cases.size(); ++i) known[key_of(cases[i])] = weights.middleCols(3 * i, 3);
  }

  /// Measures random cells, the same for all materials. Outliers have another cell's value.
  [[nodiscard]] gonio::sample_set measure(const noell_case& which) const {
    const std::size_t material = truths.find(which.material);
    return gonio::sample_table(truths.table(material), cells_of(which), {.outlier_ratio = which.outlier_ratio},
                               1000 * which.seed + material);
  }

  [[nodiscard]] std::vector<Eigen::Index> cells_of(const noell_case& which) const {
    return gonio::random_cells(truths.cells, samples_of(which.data_ratio, truths.cells.size()), which.seed);
  }

  /// Returns the non-negative combination of other materials.
  template <class Metric>
  [[nodiscard]] auto combination(const Metric& metric, const noell_case& which, const gonio::sample_set& samples) {
    const auto located = gonio::locate_samples(truths.cells, samples, threads);
    auto& plans = std::get<combinations_under<Metric>>(combinations).plans;
    const auto plan =
        plans.try_emplace({which.data_ratio, which.seed}, materials(metric), located.locations, gonio::nnls{}, threads);
    return plan.first->second.without(left_out(which, truths.names)).reconstruct(located.channels());
  }

  const gonio::correction& corrections_without(const std::vector<std::string>& names, bool printed) {
    correction_cache& cache = printed ? printed_corrections : corrections;
    if (names != cache.left_out) cache.fewer = {};
    cache.left_out = names;
    const auto rule = printed ? gonio::correction_rule::as_printed() : gonio::correction_rule{};
    const auto& all = cache.all.get([&] {
      return gonio::correction{materials(gonio::log{}), rule, gonio::nnls{}, threads};
    });
    return cache.fewer.get([&] { return all.without(names); });
  }

  /// An estimate, and the share of samples that the method rejects as outliers, if it reports one.
  struct estimated {
    gonio::brdf_table table;
    std::optional<double> outliers = {};
  };

  /// Estimates a material by a method from other materials.
  template <class Metric>
  [[nodiscard]] estimated estimate(const method_name& method, const Metric& metric, const noell_case& which,
                                   const gonio::sample_set& samples) {
    const auto tabulated = [&](const auto& estimator) -> estimated {
      return {estimator.fit(samples).tabulate(truths.cells, threads)};
    };
    if (method.method == "rbf") {
      const auto& functions = radial_functions(metric);
      const auto& known = std::get<combinations_under<Metric>>(combinations).radial_weights;
      if (const auto found = known.find(key_of(which)); found != known.end())
        return {gonio::fitted_brdf{functions, found->second}.tabulate(truths.cells, threads)};
      return tabulated(gonio::decomposition{functions, radial_penalty, threads});
    }
    if (method.method == "pull-push") return tabulated(gonio::pull_push{truths.cells, threads});
    if (method.method == "scattered") return {gonio::tabulate(interpolate(samples, {}), truths.cells, threads)};

    if (method.method == "lc") return {combination(metric, which, samples).tabulate(truths.cells, threads)};
    const std::vector<std::string> out = left_out(which, truths.names);
    const auto others = materials(metric).without(out);
    gonio::correction_limits limits;
    limits.rounds = which.iterations.value_or(limits.rounds);
    if (which.iterations) limits.smallest_change = 0.0;
    if (method.method == "our") {
      auto run = gonio::robust_reconstruction{others, corrections_without(out, false), limits, {}, threads}.initialise(
          samples);
      while (!run.converged()) run.step();
      const double good = gonio::automatic_weights{}.mixture(run.measured(), run.estimated()).inlier_fraction;
      return {run.result().tabulate(truths.cells, threads), 1.0 - good};
    }
    limits.smallest_change = 0.0;
    const bool printed = method.method == "printed";
    const double gamma = printed ? noell_gamma(which.outlier_ratio) : method.gamma;
    const auto& functions = corrections_without(out, printed);
    if (printed) limits.inertia = 0.0;
    const gonio::decomposition initial{others, gonio::nnls{}, threads};
    if (gamma == 0.0)
      return tabulated(
          gonio::correction_iteration{initial, functions, gonio::equal_weights{}, gonio::nnls{}, limits, threads});
    return tabulated(gonio::correction_iteration{initial, functions, gonio::relative_deviation_weights{gamma},
                                                 gonio::nnls{}, limits, threads});
  }

  [[nodiscard]] estimated estimate(const method_name& method, const noell_case& which,
                                   const gonio::sample_set& samples) {
    if (method.metric == "lin") return estimate(method, gonio::lin{}, which, samples);
    if (method.metric == "root") return estimate(method, gonio::root{}, which, samples);
    return estimate(method, gonio::log{}, which, samples);
  }
};

noell_experiment::noell_experiment(const std::filesystem::path& networks, const std::filesystem::path& environment,
                                   gonio::thread_count threads, const gonio::progress& listener) {
  auto truths =
      gonio::model::tabulate_networks(gonio::io::read_networks(networks), gonio::valid_cells(), threads, listener);
  const gonio::valid_cells cells = truths.cells;
  parts_.reset(new parts{threads, std::move(truths), noell_measures(cells, environment, threads), {}, {}, {}});
}

noell_experiment::~noell_experiment() = default;

const std::vector<std::string>& noell_experiment::names() const noexcept { return parts_->truths.names; }

const gonio::material_set& noell_experiment::materials() const noexcept { return parts_->truths; }

gonio::brdf_table noell_experiment::estimate(const std::string& method, const noell_case& which,
                                             const gonio::sample_set& samples) {
  return parts_->estimate(*read_method(method), which, samples).table;
}

gonio::measured<gonio::log> noell_experiment::materials_without(const std::string& material) {
  return parts_->materials(gonio::log{}).without(names_of(material));
}

const gonio::correction& noell_experiment::corrections_without(const std::string& material) {
  return parts_->corrections_without(names_of(material), false);
}

Eigen::Index noell_experiment::samples_of(double data, Eigen::Index cells) noexcept {
  return data <= 1.0 ? gonio::share_of(cells, data) : std::min<Eigen::Index>(std::llround(data), cells);
}

namespace {

/// Returns the share of samples more than 5 % off the truth. Not all outliers are off the truth: another cell's value
/// may be right.
[[nodiscard]] double share_off(const gonio::sample_set& samples, const gonio::sample_set& right) {
  constexpr double offset = 0.001, limit = 0.05;
  Eigen::Index off = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const gonio::rgb ratio = (samples[i].value.max(0.0) + offset) / (right[i].value.max(0.0) + offset);
    if (std::abs(ratio.log().mean()) > limit) ++off;
  }
  return static_cast<double>(off) / static_cast<double>(samples.size());
}

}  // namespace

json noell_experiment::run(const std::string& method, const noell_case& which) {
  const gonio::brdf_table truth = parts_->truths.table(parts_->truths.find(which.material));
  const gonio::sample_set samples = parts_->measure(which);

  // Make the corrections before the time is measured: they are not part of an iteration.
  const method_name name = *read_method(method);
  if (iterates(method))
    static_cast<void>(parts_->corrections_without(left_out(which, parts_->truths.names), name.method == "printed"));
  const auto start = std::chrono::steady_clock::now();
  const auto [estimate, outliers] = parts_->estimate(name, which, samples);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;

  json result = parts_->measures.judge(estimate, truth);
  result["seconds"] = elapsed.count();
  if (!outliers) return result;
  result["outliers"] = *outliers;
  result["off"] = share_off(samples, gonio::sample_table(truth, parts_->cells_of(which)));
  return result;
}

void noell_experiment::prepare(const std::string& method, std::span<const noell_case> cases) {
  const auto name = read_method(method);
  if (name->method != "rbf") return;
  constexpr std::size_t together = 60;  // 180 right-hand sides of a million values are 1.6 GB
  for (std::size_t begin = 0; begin < cases.size(); begin += together) {
    const auto some = cases.subspan(begin, std::min(together, cases.size() - begin));
    if (name->metric == "lin")
      parts_->solve_radial(gonio::lin{}, some);
    else if (name->metric == "root")
      parts_->solve_radial(gonio::root{}, some);
    else
      parts_->solve_radial(gonio::log{}, some);
  }
}

bool noell_experiment::iterates(const std::string& method) {
  const std::string name = read_method(method)->method;
  return name == "our" || name == "printed" || name == "gamma";
}

bool noell_experiment::combines(const std::string& method) {
  return iterates(method) || read_method(method)->method == "lc";
}

std::string noell_experiment::complaint(const std::string& method) {
  return read_method(method) ? "" : "there is no method '" + method + "'";
}

std::optional<double> noell_experiment::published(const std::string& method, double data_ratio, double outlier_ratio) {
  const auto name = read_method(method);
  const bool table_2 = data_ratio == 1.0 && outlier_ratio == 0.0 && name->metric != "log";
  const std::size_t column = name->metric == "lin" ? 0 : 1;
  if (name->method == "our" || name->method == "printed")
    return table_2 ? noell_table_2[0][column] : noell_table_1(noell_method::ours, data_ratio, outlier_ratio);
  if (name->method == "lc")
    return table_2 ? noell_table_2[1][column] : noell_table_1(noell_method::combination, data_ratio, outlier_ratio);
  if (name->method == "rbf")
    return table_2 ? noell_table_2[2][column] : noell_table_1(noell_method::radial, data_ratio, outlier_ratio);
  if (name->method == "pull-push") return noell_table_1(noell_method::pull_push, data_ratio, outlier_ratio);
  return std::nullopt;
}

}  // namespace papers
