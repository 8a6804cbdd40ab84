#pragma once
/// Runs every solver on the problems of `hard_problems` and judges the results from the rows.

#include "hard_problems.hpp"
#include "oracles/nnls_block_pivoting.hpp"
#include "oracles/nnls_coordinate_descent.hpp"
#include <gonio/solve/any_solver.hpp>
#include <gonio/solve/lasso.hpp>
#include <gonio/solve/least_squares.hpp>
#include <gonio/solve/nnls.hpp>
#include <gonio/solve/quadratic_program.hpp>
#include <gonio/solve/tikhonov.hpp>
#include <gonio/solve/truncated_svd.hpp>

#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace hard_problems {

struct tally {
  int refused = 0, wrong = 0;
  double violation = 0.0;     ///< the worst
  double disagreement = 0.0;  ///< of objectives, relative to |b|^2 / 2: the worst
  std::string first_wrong;
};

struct way {
  std::string name;
  std::function<gonio::solution(const gonio::least_squares_problem&)> solve;
  bool judged = true;  ///< by `judge`, as an optimum of least squares plus |x|_1, with or without x >= 0
  bool non_negative = true;
  double lambda = 0.0;
};

/// Returns all methods, without a penalty and with 1e-6 to 1 times the largest. Methods of one group share the optimum.
[[nodiscard]] inline std::vector<std::vector<way>> all_ways(const gonio::least_squares_problem& problem, double share) {
  const auto by = [](const auto& solver) {
    return [solver](const gonio::least_squares_problem& given) { return solver.solve(given); };
  };
  const double both = share * gonio::largest_lambda(problem.normal(), gonio::sign_rule::any),
               one = share * gonio::largest_lambda(problem.normal(), gonio::sign_rule::non_negative),
               eta = share * problem.normal().gram().diagonal().maxCoeff();
  std::vector<std::vector<way>> groups{
      {{"nnls", by(gonio::nnls())},
       {"nnls_block_pivoting", by(gonio::nnls_block_pivoting())},
       {"nnls_coordinate_descent", by(gonio::nnls_coordinate_descent())},
       {"non_negative_lasso, no penalty", by(gonio::non_negative_lasso(0.0))},
       {"quadratic_program", by(gonio::quadratic_program<>())}},
      {{"non_negative_lasso", by(gonio::non_negative_lasso(one)), true, true, one}},
      {{"lasso", by(gonio::lasso(both)), true, false, both}},
      {{"least_squares", by(gonio::least_squares()), true, false}},
      {{"quadratic_program, convex", by(gonio::quadratic_program<gonio::convex_weights>()), false}},
      {{"truncated_svd", by(gonio::truncated_svd(0.99)), false}}};
  if (eta > 0.0) groups.push_back({{"tikhonov", by(gonio::tikhonov(eta)), false}});
  return groups;
}

/// Solves problem `seed` of a family by all methods and adds the results to the tallies of the solvers.
inline void check(family what, unsigned seed, std::map<std::string, tally>& tallies) {
  generator random(seed);
  const auto problem = random.make(what);
  const gonio::least_squares_problem given = equations(problem);
  const double share = std::pow(10.0, -6.0 * static_cast<double>(seed % 97) / 96.0);
  for (const auto& group : all_ways(given, share)) {
    std::optional<double> reference;
    for (const way& each : group) {
      tally& sum = tallies[each.name];
      const auto wrong = [&](const std::string& why) {
        if (sum.wrong++ == 0)
          sum.first_wrong =
              std::string(names[static_cast<std::size_t>(what)]) + ", seed " + std::to_string(seed) + ": " + why;
      };
      gonio::solution found;
      try {
        found = each.solve(given);
      } catch (const gonio::error& refused) {
        if (sum.refused++ == 0 && sum.wrong == 0)
          sum.first_wrong = "(refused) " + std::string(names[static_cast<std::size_t>(what)]) + ", seed " +
                            std::to_string(seed) + ": " + refused.what();
        continue;
      }
      if (!(found.report.kkt_residual[0] <= 1e-9))
        wrong("KKT residual " + std::to_string(found.report.kkt_residual[0] * 1e9) + "e-9");
      if (!found.weights.allFinite()) wrong("not finite");
      if (!each.judged) continue;
      if (each.non_negative && found.weights.minCoeff() < 0.0) wrong("negative");
      const verdict by_rows = judge(problem, found.weights.col(0), each.lambda, each.non_negative);
      sum.violation = std::max(sum.violation, by_rows.violation);
      if (!(by_rows.violation <= 1e-9)) wrong("violation " + std::to_string(by_rows.violation * 1e9) + "e-9");
      if (!(by_rows.residual <= 1.0 + 1e-12)) wrong("residual " + std::to_string(by_rows.residual) + " |b|");
      if (!reference) reference = by_rows.objective;
      const double apart = std::abs(by_rows.objective - *reference);
      sum.disagreement = std::max(sum.disagreement, apart);
      if (!(apart <= 1e-9)) wrong("objectives differ by " + std::to_string(apart * 1e9) + "e-9");
    }
  }
}

}  // namespace hard_problems
