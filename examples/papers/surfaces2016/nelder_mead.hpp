#pragma once
/// Minimises a function without derivatives. Nelder and Mead, "A simplex method for function minimization" (The
/// Computer Journal 7(4), 1965, doi:10.1093/comjnl/7.4.308), with the coefficients of Gao and Han for many dimensions
/// (Computational Optimization and Applications 51, 2012, doi:10.1007/s10589-010-9329-3).

#include <Eigen/Core>

#include <algorithm>
#include <numeric>
#include <vector>

namespace papers {

/// When the search stops, and the size of its first simplex.
struct nelder_mead_options {
  double first_step = 0.25;  ///< along each axis
  double tolerance = 1e-4;   ///< of the largest difference of the simplex' values
  int most_evaluations = 2000;
};

/// Returns the best point that was found from `start`.
template <class Function>
[[nodiscard]] Eigen::VectorXd nelder_mead(Function&& function, const Eigen::VectorXd& start,
                                          const nelder_mead_options& options = {}) {
  const Eigen::Index n = start.size();
  const auto size = static_cast<double>(n);
  const double expansion = 1.0 + 2.0 / size, contraction = 0.75 - 0.5 / size, shrinkage = 1.0 - 1.0 / size;
  Eigen::MatrixXd corners = start.replicate(1, n + 1);
  Eigen::VectorXd values(n + 1);
  for (Eigen::Index i = 0; i <= n; ++i) {
    if (i < n) corners(i, i) += options.first_step;
    values[i] = function(corners.col(i));
  }
  int evaluations = static_cast<int>(n) + 1;
  std::vector<Eigen::Index> order(n + 1);
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  for (;;) {
    std::ranges::sort(order, {}, [&](Eigen::Index corner) { return values[corner]; });
    const Eigen::Index best = order.front(), worst = order.back();
    if (values[worst] - values[best] <= options.tolerance || evaluations >= options.most_evaluations)
      return corners.col(best);
    const Eigen::VectorXd middle = (corners.rowwise().sum() - corners.col(worst)) / size;
    // Replaces the worst corner by a point on its line through the middle if that is better.
    const auto replaced = [&](double share) {
      const Eigen::VectorXd point = middle + share * (corners.col(worst) - middle);
      const double value = function(point);
      ++evaluations;
      if (!(value < values[worst])) return false;
      corners.col(worst) = point;
      values[worst] = value;
      return true;
    };
    const double least = values[best], second_worst = values[order[n - 1]];
    if (replaced(-1.0)) {
      if (values[worst] < least) replaced(expansion);
      if (values[worst] < second_worst) continue;
    }
    if (replaced(contraction)) continue;
    // Shrink the simplex about the best corner.
    for (const Eigen::Index corner : order) {
      if (corner == best) continue;
      corners.col(corner) = corners.col(best) + shrinkage * (corners.col(corner) - corners.col(best));
      values[corner] = function(corners.col(corner));
      ++evaluations;
    }
  }
}

}  // namespace papers
