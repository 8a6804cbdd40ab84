#pragma once
/// Random least-squares problems of sixteen families on which solvers have failed, here or elsewhere. Solutions are
/// judged from the rows in extended precision, independently of any solver.

#include "random_problems.hpp"
#include <gonio/solve/least_squares_problem.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace hard_problems {

enum class family {
  ordinary,
  non_negative_data,
  near_duplicates,  // columns that differ by 1e-4 to 1e-12
  monotone,         // lower triangular, rows weighted by the roots of counts: monotone regression (scipy 20168)
  nearly_low_rank,  // low rank plus 1e-12
  row_weights,      // rows times 1e-8 to 1e8
  column_scales,    // columns times 1e-12 to 1e12
  tiny,             // everything times 1e-120
  huge,             // everything times 1e120
  wide,             // fewer rows than columns
  duplicated,       // each column twice, or with the opposite sign
  zero_columns,
  ill_conditioned,      // condition up to 1e12
  kahan,                // triangles whose condition number pivots do not reveal
  nearly_antiparallel,  // columns that cancel up to 1e-3 to 1e-9
  degenerate            // small integers: weights and gradients that are exactly zero
};
inline constexpr int families = 16;
inline constexpr std::array<const char*, families> names{"ordinary",
                                                         "non-negative data",
                                                         "near-duplicate columns",
                                                         "monotone lower-triangular",
                                                         "low rank + 1e-12",
                                                         "rows times 1e+-8",
                                                         "columns times 1e+-12",
                                                         "tiny, 1e-120",
                                                         "huge, 1e120",
                                                         "wide",
                                                         "duplicated columns",
                                                         "zero columns",
                                                         "condition up to 1e12",
                                                         "Kahan's triangles",
                                                         "nearly antiparallel",
                                                         "degenerate integers"};

class generator : random_problems::generator {
 public:
  using random_problems::generator::generator;

  [[nodiscard]] random_problems::problem make(family what) {
    const Eigen::Index k = integer(2, 15), n = what == family::wide ? integer(1, k - 1) : integer(k, 3 * k);
    random_problems::problem made{gaussian(n, k), gaussian(n, 1)};
    Eigen::MatrixXd& a = made.matrix;
    if (what == family::non_negative_data) a = a.cwiseAbs(), made.right = made.right.cwiseAbs();
    if (what == family::near_duplicates)
      for (Eigen::Index copy = integer(1, k - 1); copy > 0; --copy)
        a.col(copy) = a.col(integer(0, copy - 1)) + std::pow(10.0, uniform(-12.0, -4.0)) * gaussian(n, 1);
    if (what == family::monotone) made = monotone(k);
    if (what == family::nearly_low_rank) {
      const Eigen::Index rank = integer(1, k - 1);
      a = gaussian(n, rank) * gaussian(rank, k) + 1e-12 * gaussian(n, k);
    }
    if (what == family::row_weights)
      for (Eigen::Index row = 0; row < n; ++row) {
        const double scale = std::pow(10.0, uniform(-8.0, 8.0));
        a.row(row) *= scale;
        made.right[row] *= scale;
      }
    if (what == family::column_scales)
      for (Eigen::Index j = 0; j < k; ++j) a.col(j) *= std::pow(10.0, uniform(-12.0, 12.0));
    if (what == family::tiny || what == family::huge) {
      const double scale = what == family::tiny ? 1e-120 : 1e120;
      a *= scale;
      made.right *= scale;
    }
    if (what == family::duplicated)
      for (Eigen::Index copy = integer(1, k - 1); copy > 0; --copy)
        a.col(copy) = (integer(0, 3) == 0 ? -1.0 : 1.0) * a.col(integer(0, copy - 1));
    if (what == family::zero_columns)
      for (Eigen::Index zero = integer(1, k); zero > 0; --zero) a.col(integer(0, k - 1)).setZero();
    if (what == family::ill_conditioned) {
      const Eigen::MatrixXd left = dense_reference::orthonormal_columns(gaussian(n, k));
      Eigen::MatrixXd turn = dense_reference::orthonormal_columns(gaussian(k, k));
      const double smallest = uniform(-12.0, -3.0);
      for (Eigen::Index j = 0; j < k; ++j)
        turn.row(j) *= std::pow(10.0, smallest * static_cast<double>(j) / static_cast<double>(k - 1));
      a = left * turn;
    }
    if (what == family::kahan) made = kahan(integer(2, 40));
    if (what == family::nearly_antiparallel)
      for (Eigen::Index j = 0; j + 1 < k; j += 2)
        a.col(j + 1) = std::pow(10.0, uniform(-9.0, -3.0)) * gaussian(n, 1) - uniform(0.1, 10.0) * a.col(j);
    if (what == family::degenerate) {
      for (Eigen::Index row = 0; row < n; ++row) {
        for (Eigen::Index j = 0; j < k; ++j) a(row, j) = static_cast<double>(integer(-2, 2));
        made.right[row] = static_cast<double>(integer(-3, 3));
      }
      a.row(n - 1) *= static_cast<double>(integer(1, 2000));
    }
    return made;
  }

 private:
  [[nodiscard]] random_problems::problem monotone(Eigen::Index k) {
    random_problems::problem made{Eigen::MatrixXd::Zero(k, k), Eigen::VectorXd::Zero(k)};
    for (Eigen::Index row = 0; row < k; ++row) {
      const auto count = static_cast<double>(integer(0, 12));
      for (Eigen::Index j = 0; j <= row; ++j) made.matrix(row, j) = count;
      made.right[row] = std::floor(uniform(0.0, count + 1.0));
      if (count == 0.0) {  // no count: no step upwards is wanted
        made.matrix(row, row) = 1.0;
        if (row + 1 < k) made.matrix(row, row + 1) = -1.0;
        made.right[row] = 0.0;
      }
      const double weight = count == 0.0 ? 1.0 : std::sqrt(count);
      made.matrix.row(row) *= weight;
      made.right[row] *= weight;
    }
    return made;
  }

  /// W. Kahan, "Numerical linear algebra", Canadian Math. Bulletin 9, 1966.
  [[nodiscard]] random_problems::problem kahan(Eigen::Index k) {
    const double angle = uniform(0.8, 1.4), cosine = std::cos(angle), sine = std::sin(angle);
    random_problems::problem made{Eigen::MatrixXd::Zero(k, k), gaussian(k, 1)};
    for (Eigen::Index row = 0; row < k; ++row) {
      made.matrix(row, row) = std::pow(sine, static_cast<double>(row));
      for (Eigen::Index j = row + 1; j < k; ++j)
        made.matrix(row, j) = -cosine * std::pow(sine, static_cast<double>(row));
    }
    if (integer(0, 1) == 1) made.right.setConstant(1.0);
    return made;
  }
};

/// The quality of a solution: all relative, in extended precision.
struct verdict {
  double violation = 0.0;  ///< of the KKT conditions, for columns of length 1, relative to |b| + sum of |a_j| |x_j|
  double residual = 0.0;   ///< |A x - b| / |b|
  double objective = 0.0;  ///< (|A x - b|^2 / 2 + lambda |x|_1) / (|b|^2 / 2)
};

[[nodiscard]] inline verdict judge(const random_problems::problem& problem, const Eigen::VectorXd& x, double lambda,
                                   bool non_negative) {
  using extended = long double;
  const Eigen::Index n = problem.matrix.rows(), k = problem.matrix.cols();
  std::vector<extended> misfit(n);
  extended squares = 0, rhs_squared_norm = 0, magnitude = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    extended& left = misfit[i];
    left = problem.right[i];
    rhs_squared_norm += left * left;
    for (Eigen::Index j = 0; j < k; ++j) left -= static_cast<extended>(problem.matrix(i, j)) * x[j];
    squares += left * left;
    magnitude = 0;
  }
  std::vector<extended> slope(k), length(k);
  for (Eigen::Index j = 0; j < k; ++j) {
    const std::size_t at = j;
    for (Eigen::Index i = 0; i < n; ++i) {
      const extended a = problem.matrix(i, j);
      slope[at] += a * misfit[i];
      length[at] += a * a;
    }
    length[at] = length[at] > 0 ? std::sqrt(length[at]) : 1;
    magnitude += length[at] * std::abs(static_cast<extended>(x[j]));
  }
  magnitude += std::sqrt(rhs_squared_norm);
  extended worst = 0, sum = 0;
  for (Eigen::Index j = 0; j < k; ++j) {
    const std::size_t at = j;
    const extended penalty = lambda, g = slope[at];
    extended off = 0;
    if (x[j] > 0)
      off = std::abs(g - penalty);
    else if (x[j] < 0)
      off = std::abs(g + penalty);
    else
      off = (non_negative ? g : std::abs(g)) - penalty;
    worst = std::max(worst, off / length[at]);
    sum += std::abs(static_cast<extended>(x[j]));
  }
  const extended whole = rhs_squared_norm > 0 ? rhs_squared_norm : 1;
  return {static_cast<double>(worst / (magnitude > 0 ? magnitude : 1)), static_cast<double>(std::sqrt(squares / whole)),
          static_cast<double>((squares + 2 * lambda * sum) / whole)};
}

[[nodiscard]] inline gonio::least_squares_problem equations(const random_problems::problem& problem) {
  return {gonio::row_matrix(problem.matrix), Eigen::MatrixXd(problem.right)};
}

}  // namespace hard_problems
