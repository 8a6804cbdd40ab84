/// Nielsen et al. 2015, section 5: the effect of the penalty. Least squares (eta = 0), ridge and Lasso.

#include "papers/experiments.hpp"
#include "papers/nielsen2015/nielsen_split.hpp"
#include "papers/xu2016/figures.hpp"
#include <gonio/design/published_directions.hpp>
#include <gonio/solve/lasso.hpp>
#include <gonio/solve/least_squares.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <algorithm>
#include <array>
#include <random>

namespace papers::figures {

namespace {

constexpr std::array etas{0.1, 1.0, 4.0, 10.0, 40.0, 100.0, 400.0, 1000.0};
/// Penalties for `lasso`, which minimises half the sum of squared residuals plus lambda |x|_1. Without the factor 1/2,
/// as in Eq. 11 with |c|_1 in place of |c|^2, the same penalties would be twice as large.
constexpr std::array lambdas{0.01, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0};

/// The measurements of one set, and their least-squares problem.
struct measured_set {
  std::string name;
  Eigen::Index count = 0;
  gonio::least_squares_problem problem;
};

/// Adds Gaussian noise to mapped values. Small deviations correspond to relative noise.
gonio::least_squares_problem with_noise(const gonio::least_squares_problem& problem, double deviation,
                                        std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal(0.0, deviation);
  Eigen::MatrixXd values = problem.right_hand_side();
  for (double& value : values.reshaped()) value += normal(generator);
  return {problem.rows(), std::move(values)};
}

/// Returns the published sets, and our sets by expected error, which ship with the tool.
std::vector<measured_set> sets_of(const laboratory& lab, const options& given) {
  std::vector<measured_set> sets;
  for (const char* name : {"published", "expected-error"})
    for (const Eigen::Index n : gonio::design::nielsen_direction_counts) {
      if (n > static_cast<Eigen::Index>(given.up_to(20))) continue;
      const auto directions = written_points(shipped_directions(), name, n);
      if (directions) sets.push_back({name, n, lab.tested.problem_of(*directions)});
    }
  return sets;
}

/// The result of one penalty.
struct outcome {
  /// `error` is the mean mapped error, `weights` the mean number of nonzero weights.
  double penalty = 0.0, error = 0.0, weights = 0.0;
};

template <gonio::solver Solver>
outcome solved(const laboratory& lab, const gonio::least_squares_problem& problem, double penalty,
               const Solver& solver) {
  const Eigen::MatrixXd weights = solver.solve(problem).weights;
  const double used = static_cast<double>((weights.array() != 0.0).count());
  return {penalty, lab.tested.of_weights(weights).mean(), used / static_cast<double>(weights.cols())};
}

template <class Solver, std::size_t Count>
std::vector<outcome> solved_with_each(const laboratory& lab, const gonio::least_squares_problem& problem,
                                      const std::array<double, Count>& penalties) {
  std::vector<outcome> outcomes;
  for (const double penalty : penalties) outcomes.push_back(solved(lab, problem, penalty, Solver(penalty)));
  return outcomes;
}

std::string short_number(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// Tabulates errors by penalty, one row per set.
template <std::size_t Count>
table curves(const std::string& title, const std::string& symbol, const std::array<double, Count>& penalties,
             const std::vector<measured_set>& sets, const std::vector<std::vector<outcome>>& outcomes) {
  table shown{title, {{"set"}, {"n", 0}}};
  for (const double penalty : penalties) shown.columns.push_back({symbol + " = " + short_number(penalty)});
  for (std::size_t s = 0; s < sets.size(); ++s) {
    auto& row = shown.rows.emplace_back(std::vector<json>{sets[s].name, sets[s].count});
    for (const outcome& each : outcomes[s]) row.emplace_back(each.error);
  }
  return shown;
}

/// Compares all methods. The best penalties are chosen in hindsight.
table beside_each_other(const std::string& title, const laboratory& lab, const options& given,
                        const std::vector<measured_set>& sets, const std::vector<std::vector<outcome>>& ridges,
                        const std::vector<std::vector<outcome>>& lassos) {
  table shown{title,
              {{"set"},
               {"n", 0},
               {"eta = 0"},
               {"ridge, eta = " + short_number(given.eta)},
               {"ridge, the best eta"},
               {"that eta", 1},
               {"Lasso, the best lambda"},
               {"that lambda", 2},
               {"weights not zero", 1}}};
  for (std::size_t s = 0; s < sets.size(); ++s) {
    const gonio::least_squares_problem& problem = sets[s].problem;
    const outcome ridge = std::ranges::min(ridges[s], {}, &outcome::error);
    const outcome lasso = std::ranges::min(lassos[s], {}, &outcome::error);
    shown.rows.push_back({sets[s].name, sets[s].count, solved(lab, problem, 0.0, gonio::least_squares()).error,
                          solved(lab, problem, given.eta, gonio::tikhonov(given.eta)).error, ridge.error, ridge.penalty,
                          lasso.error, lasso.penalty, lasso.weights});
  }
  return shown;
}

/// Tabulates errors of one solver with the first k components. With more components than measurements, least squares
/// has no inverse (Eq. 9) and returns the shortest weights that fit.
template <gonio::solver Solver>
table by_components(const std::string& title, const laboratory& lab, const options& given,
                    const std::vector<measured_set>& sets, const Solver& solver) {
  const Eigen::Index all = lab.prior().size();
  std::vector<Eigen::Index> swept = given.swept_components({1, 2, 3, 5, 10, 15, 20, 30, 50, 100}, all);
  swept.push_back(all);
  table shown{title, {{"set"}, {"n", 0}}};
  for (const Eigen::Index k : swept) shown.columns.push_back({"k = " + std::to_string(k)});
  for (const measured_set& set : sets) {
    auto& row = shown.rows.emplace_back(std::vector<json>{set.name, set.count});
    for (const Eigen::Index k : swept) {
      const gonio::least_squares_problem first(set.problem.rows().leftCols(k), set.problem.right_hand_side());
      Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(all, set.problem.right_hand_side().cols());
      weights.topRows(k) = solver.solve(first).weights;
      row.emplace_back(lab.tested.of_weights(weights).mean());
    }
  }
  return shown;
}

/// Returns all tables for some sets.
tables compared(const std::string& condition, const laboratory& lab, const options& given,
                const std::vector<measured_set>& sets) {
  std::vector<std::vector<outcome>> ridges, lassos;
  for (const measured_set& set : sets) {
    ridges.push_back(solved_with_each<gonio::tikhonov>(lab, set.problem, etas));
    lassos.push_back(solved_with_each<gonio::lasso>(lab, set.problem, lambdas));
  }
  return {beside_each_other("Mean mapped error of the ten materials, " + condition, lab, given, sets, ridges, lassos),
          curves("Ridge, " + condition, "eta", etas, sets, ridges),
          curves("Lasso, " + condition, "lambda", lambdas, sets, lassos),
          by_components("Least squares with the first k components, " + condition + ": Eq. 9 where k is at most n", lab,
                        given, sets, gonio::least_squares()),
          by_components("Ridge, eta = " + short_number(given.eta) + ", with the first k components, " + condition, lab,
                        given, sets, gonio::tikhonov(given.eta))};
}

}  // namespace

tables nielsen_penalties(const options& given, const gonio::progress& listener) {
  constexpr double noise = 0.02;
  const laboratory lab = open_laboratory(given, listener);
  std::vector<measured_set> sets = sets_of(lab, given);
  gonio::report(listener, "penalties", 0.0);
  tables shown = compared("without noise", lab, given, sets);
  for (measured_set& set : sets) set.problem = with_noise(set.problem, noise, given.seed);
  gonio::report(listener, "penalties", 0.5);
  tables noisy = compared("2 % noise", lab, given, sets);
  shown.insert(shown.end(), std::make_move_iterator(noisy.begin()), std::make_move_iterator(noisy.end()));
  return shown;
}

}  // namespace papers::figures
