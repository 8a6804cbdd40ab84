#pragma once
/// Random quadratic programs of every kind that is hard for solvers, and their optima by brute force.

#include "random_problems.hpp"
#include <gonio/solve/linear_constraints.hpp>
#include <gonio/solve/normal_equations.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <optional>
#include <random>
#include <utility>
#include <vector>

namespace programs {

using matrix = Eigen::MatrixXd;
using vector = Eigen::VectorXd;

/// The product, compiled once.
inline matrix times(const matrix& a, const matrix& b) { return a * b; }

inline vector numbers(std::initializer_list<double> list) {
  return Eigen::Map<const vector>(list.begin(), std::ssize(list));
}

/// Shrinks A along orthogonal random directions, the last one by 10^-decades (twice as many decades in Q).
inline void worsen(matrix& A, double decades, unsigned seed) {
  const Eigen::Index k = A.cols();
  matrix directions = random_matrix(k, k, seed + 17);
  for (Eigen::Index i = 0; i < k; ++i) {
    for (int pass = 0; pass < 2; ++pass)
      for (Eigen::Index j = 0; j < i; ++j)
        directions.col(i) -= directions.col(j).dot(directions.col(i)) * directions.col(j);
    directions.col(i).normalize();
    const double shrink = std::pow(10.0, -decades * (static_cast<double>(i) + 1.0) / static_cast<double>(k));
    A -= (1.0 - shrink) * times(times(A, directions.col(i)), directions.col(i).transpose());
  }
}

/// Normal equations of random data: well or ill-conditioned, with dependent columns, with fewer rows than columns, or
/// zero.
struct random_problem {
  matrix Q;
  vector m;
  double decades = 0.0;

  random_problem(Eigen::Index k, int kind, unsigned seed) {
    const Eigen::Index n = kind == 1 ? std::max<Eigen::Index>(1, k / 2) : k + 3;
    matrix A = random_matrix(n, k, seed);
    if (kind == 2) A.rightCols(k / 2) = A.leftCols(k / 2).eval();
    if (kind == 3) A.col(k / 2).setZero();
    if (kind == 4) A = times(A.leftCols(2), A.topRows(2));
    if (kind == 5) A = A.cwiseAbs();
    if (kind == 6) worsen(A, decades = static_cast<double>(seed % 71) * 0.1, seed);
    vector b = random_matrix(n, 1, seed + 100);
    if (kind == 7) {  // x = 0 is the optimum under x >= 0
      A = A.cwiseAbs();
      b = -b.cwiseAbs();
    }
    Q = times(A.transpose(), A);
    m = times(A.transpose(), b);
  }
  static constexpr int kinds = 8;

  [[nodiscard]] double scale() const { return m.cwiseAbs().maxCoeff(); }
};

/// Extended precision, because the objective of an ill-conditioned problem cancels.
using extended = std::vector<long double>;

inline double objective(const random_problem& problem, const extended& x) {
  long double sum = 0;
  for (std::size_t j = 0; j < x.size(); ++j) {
    const Eigen::Index column = j;
    for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * x[j] * static_cast<long double>(problem.Q(i, column)) / 2;
    sum -= static_cast<long double>(problem.m[column]) * x[j];
  }
  return static_cast<double>(sum);
}

/// A linear system; the last column is the right-hand side.
struct extended_system {
  std::vector<extended> rows;

  explicit extended_system(std::size_t size) : rows(size, extended(size + 1, 0.0L)) {}

  /// Returns a solution, if one exists, by elimination with complete pivoting.
  [[nodiscard]] std::optional<extended> solve() {
    const std::size_t n = rows.size();
    std::vector<Eigen::Index> order(n);
    for (std::size_t i = 0; i < n; ++i) order[i] = i;
    std::size_t rank = 0;
    for (; rank < n && pivot(rank, order); ++rank)
      for (std::size_t i = rank + 1; i < n; ++i) {
        const long double factor = rows[i][rank] / rows[rank][rank];
        for (std::size_t j = rank; factor != 0 && j <= n; ++j) rows[i][j] -= factor * rows[rank][j];
      }
    for (std::size_t i = rank; i < n; ++i)
      if (std::abs(rows[i][n]) > 1e-10L) return std::nullopt;
    extended x(n, 0.0L);
    for (std::size_t i = rank; i-- > 0;) {
      long double sum = rows[i][n];
      for (std::size_t j = i + 1; j < rank; ++j) sum -= rows[i][j] * x[order[j]];
      x[order[i]] = sum / rows[i][i];
    }
    return x;
  }

 private:
  [[nodiscard]] bool pivot(std::size_t at, std::vector<Eigen::Index>& order) {
    const std::size_t n = rows.size();
    std::size_t row = at, column = at;
    for (std::size_t i = at; i < n; ++i)
      for (std::size_t j = at; j < n; ++j)
        if (std::abs(rows[i][j]) > std::abs(rows[row][column])) {
          row = i;
          column = j;
        }
    std::swap(rows[at], rows[row]);
    std::swap(order[at], order[column]);
    for (extended& each : rows) std::swap(each[at], each[column]);
    return std::abs(rows[at][at]) > 1e-14L;
  }
};

/// Returns the KKT system with the active inequalities as equations: first the bounds, then the rows.
inline extended_system kkt_system(const random_problem& problem, const gonio::linear_constraints& constraints,
                                  unsigned active) {
  const auto at = [](Eigen::Index i) { return i; };
  const Eigen::Index k = problem.m.size(), bounds = constraints.non_negative ? k : 0;
  const Eigen::Index equalities = constraints.e.size(), size = k + equalities + constraints.d.size();
  extended_system system(at(size));
  for (Eigen::Index j = 0; j < k; ++j) {
    const bool fixed = j < bounds && (active >> j & 1U) != 0;
    for (Eigen::Index i = 0; i < k; ++i) system.rows[at(j)][at(i)] = fixed ? i == j : problem.Q(i, j);
    system.rows[at(j)][at(size)] = fixed ? 0.0 : problem.m[j];
  }
  for (Eigen::Index i = 0; i < size - k; ++i) {
    const bool equality = i < equalities;
    extended& row = system.rows[at(k + i)];
    if (!equality && (active >> (bounds + i - equalities) & 1U) == 0) {
      row[at(k + i)] = 1;
      continue;
    }
    for (Eigen::Index j = 0; j < k; ++j) {
      row[at(j)] = equality ? constraints.E(i, j) : constraints.D(i - equalities, j);
      const bool fixed = j < bounds && (active >> j & 1U) != 0;
      if (!fixed) system.rows[at(j)][at(k + i)] = row[at(j)];
    }
    row[at(size)] = equality ? constraints.e[i] : constraints.d[i - equalities];
  }
  return system;
}

inline bool feasible(const extended& x, const gonio::linear_constraints& constraints) {
  if (constraints.non_negative && *std::ranges::min_element(x) < -1e-10L) return false;
  for (Eigen::Index i = 0; i < constraints.d.size(); ++i) {
    long double sum = -constraints.d[i];
    for (std::size_t j = 0; j < x.size(); ++j) sum += x[j] * constraints.D(i, j);
    if (sum > 1e-10L) return false;
  }
  return true;
}

/// Returns the lowest objective of all feasible points that are stationary on some set of active constraints.
inline double lowest_objective(const random_problem& problem, const gonio::linear_constraints& constraints) {
  const std::size_t k = problem.m.size();
  const std::size_t inequalities = constraints.d.size() + (constraints.non_negative ? k : 0);
  double lowest = std::numeric_limits<double>::infinity();
  for (unsigned active = 0; active < 1U << inequalities; ++active) {
    auto x = kkt_system(problem, constraints, active).solve();
    if (!x) continue;
    x->resize(k);
    if (feasible(*x, constraints)) lowest = std::min(lowest, objective(problem, *x));
  }
  return lowest;
}

/// Returns random rows that hold at some x >= 0, some with equality.
inline gonio::linear_constraints random_constraints(Eigen::Index k, Eigen::Index rows, Eigen::Index equalities,
                                                    bool non_negative, unsigned seed) {
  gonio::linear_constraints made{.non_negative = non_negative};
  const vector inside = random_matrix(k, 1, seed).cwiseMax(0.0);
  const vector slack = random_matrix(std::max<Eigen::Index>(1, rows), 1, seed + 1).cwiseMax(0.0);
  made.D = random_matrix(rows, k, seed + 2);
  made.d = times(made.D, inside) + slack.head(rows);
  made.E = random_matrix(equalities, k, seed + 3);
  made.e = times(made.E, inside);
  return made;
}

/// The same problem with rescaled columns; objectives do not change.
struct scaled {
  vector by;
  scaled(Eigen::Index k, unsigned seed) : by(k) {
    std::mt19937 generator(seed);
    std::uniform_int_distribution<int> decades(-12, 12);
    for (Eigen::Index j = 0; j < k; ++j) by[j] = std::ldexp(1.0, static_cast<int>(3.3 * decades(generator)));
  }
  [[nodiscard]] gonio::normal_equations equations(const random_problem& problem) const {
    matrix Q = problem.Q;
    for (Eigen::Index j = 0; j < by.size(); ++j) Q.col(j) = by[j] * Q.col(j).cwiseProduct(by);
    return {std::move(Q), problem.m.cwiseProduct(by)};
  }
  [[nodiscard]] gonio::linear_constraints constraints(gonio::linear_constraints rows) const {
    for (Eigen::Index j = 0; j < rows.D.cols(); ++j) rows.D.col(j) *= by[j];
    for (Eigen::Index j = 0; j < rows.E.cols(); ++j) rows.E.col(j) *= by[j];
    return rows;
  }
};

}  // namespace programs
