#pragma once
/// Random least-squares problems, including difficult ones, on which all solvers must agree.

#include "../dense_reference.hpp"
#include <gonio/solve/normal_equations.hpp>

#include <cmath>
#include <random>
#include <string>
#include <vector>

/// Standard normal numbers.
inline Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd matrix(rows, columns);
  for (double& value : matrix.reshaped()) value = normal(generator);
  return matrix;
}

/// Returns the distance between two solutions, relative to their size unless they are small.
inline double relative_distance(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).norm() / (1.0 + b.norm());
}

namespace random_problems {

/// The special property of a problem.
enum class kind {
  ordinary,
  non_negative_data,  // like reflectance: all entries >= 0, similar columns
  rank_deficient,
  duplicated_columns,
  zero_columns,
  all_zero_optimum,
  wide,
  ill_conditioned,  // the Gram matrix has a condition number up to 1e14
  badly_scaled,     // columns of lengths 1e-12 to 1e12
  tiny,             // everything times 1e-12
  huge              // everything times 1e12
};
inline constexpr int kinds = 11;

struct problem {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right;

  [[nodiscard]] gonio::normal_equations normal() const {
    return {matrix.transpose() * matrix, matrix.transpose() * right, Eigen::VectorXd::Constant(1, right.squaredNorm())};
  }
};

class generator {
 public:
  explicit generator(unsigned seed) : engine_(seed) {}

  [[nodiscard]] double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  [[nodiscard]] Eigen::Index integer(Eigen::Index low, Eigen::Index high) {
    return std::uniform_int_distribution<Eigen::Index>(low, high)(engine_);
  }
  [[nodiscard]] Eigen::MatrixXd gaussian(Eigen::Index rows, Eigen::Index columns) {
    std::normal_distribution<double> normal;
    Eigen::MatrixXd matrix(rows, columns);
    for (double& value : matrix.reshaped()) value = normal(engine_);
    return matrix;
  }

  [[nodiscard]] problem make(kind what, Eigen::Index largest = 25) {
    const Eigen::Index k = integer(2, largest), n = what == kind::wide ? integer(1, k - 1) : integer(k, 4 * k);
    problem made{gaussian(n, k), gaussian(n, 1)};
    if (what == kind::non_negative_data) {
      const Eigen::VectorXd common = gaussian(n, 1).cwiseAbs();
      made.matrix = made.matrix.cwiseAbs() * uniform(0.01, 1.0) + common.replicate(1, k);
      made.right = made.right.cwiseAbs() + common;
    } else if (what == kind::rank_deficient) {
      const Eigen::Index rank = integer(1, k - 1);
      made.matrix = gaussian(n, rank) * gaussian(rank, k);
    } else if (what == kind::duplicated_columns) {
      for (Eigen::Index copy = integer(1, k / 2); copy > 0; --copy)
        made.matrix.col(integer(0, k - 1)) = made.matrix.col(integer(0, k - 1)).eval();
    } else if (what == kind::zero_columns) {
      for (Eigen::Index column = integer(1, k); column > 0; --column) made.matrix.col(integer(0, k - 1)).setZero();
    } else if (what == kind::all_zero_optimum) {
      made.matrix = made.matrix.cwiseAbs();
      made.right = -made.right.cwiseAbs();
    } else if (what == kind::ill_conditioned) {
      const Eigen::MatrixXd left = dense_reference::orthonormal_columns(gaussian(n, k));
      const Eigen::MatrixXd turn = dense_reference::orthonormal_columns(gaussian(k, k));
      const double smallest = uniform(-7.0, -3.0);
      Eigen::VectorXd sigma(k);
      for (Eigen::Index j = 0; j < k; ++j)
        sigma[j] = std::pow(10.0, smallest * static_cast<double>(j) / static_cast<double>(k - 1));
      made.matrix = left * sigma.asDiagonal() * turn;
    } else if (what == kind::badly_scaled) {
      for (Eigen::Index j = 0; j < k; ++j) made.matrix.col(j) *= std::pow(10.0, uniform(-12.0, 12.0));
    } else if (what == kind::tiny || what == kind::huge) {
      const double scale = what == kind::tiny ? 1e-12 : 1e12;
      made.matrix *= scale;
      made.right *= scale;
    }
    return made;
  }

 private:
  std::mt19937 engine_;
};

}  // namespace random_problems
