#pragma once
/// Weighted linear least squares: minimise the sum over rows of w (a x - b)^2 for one or more right-hand
/// sides b. Noell, Koehler and Stricker 2014, Eq. 7-10.

#include <gonio/core/error.hpp>

#include <Eigen/Core>

#include <cmath>
#include <memory>
#include <mutex>
#include <string>

namespace gonio {

/// A matrix whose rows are contiguous, as equations come in.
using row_matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Q = A' W A and A' W b, one column of `moment` for each right-hand side.
struct normal_equations {
  Eigen::MatrixXd gram;
  Eigen::MatrixXd moment;
};

/// The equations of a least-squares problem, tall (a million rows by 99) or wide (5 rows by 300). The
/// normal equations are built once, on demand, in double precision; asking for them is thread safe, and
/// copies share them.
class least_squares_problem {
 public:
  /// `rows` is n x k, `right_hand_side` n x r, `weights` n (all 1 if empty). Throws gonio::error if the
  /// sizes do not match, the problem is empty, a number is not finite or a weight is negative, naming the
  /// first offending row.
  least_squares_problem(row_matrix rows, Eigen::MatrixXd right_hand_side, Eigen::VectorXd weights = {})
      : rows_(std::move(rows)), right_hand_side_(std::move(right_hand_side)), weights_(std::move(weights)) {
    if (weights_.size() == 0) weights_ = Eigen::VectorXd::Ones(rows_.rows());
    require_consistent();
  }

  /// A: n x k.
  [[nodiscard]] const row_matrix& rows() const noexcept { return rows_; }
  /// b: n x r.
  [[nodiscard]] const Eigen::MatrixXd& right_hand_side() const noexcept { return right_hand_side_; }
  /// The diagonal of W: n.
  [[nodiscard]] const Eigen::VectorXd& weights() const noexcept { return weights_; }

  [[nodiscard]] Eigen::Index equations() const noexcept { return rows_.rows(); }
  [[nodiscard]] Eigen::Index unknowns() const noexcept { return rows_.cols(); }

  /// O(n k^2) the first time.
  [[nodiscard]] const normal_equations& normal() const {
    std::call_once(normal_->built, [&] {
      row_matrix weighted = rows_;
      for (Eigen::Index row = 0; row < equations(); ++row) weighted.row(row) *= weights_[row];
      normal_->equations.gram.noalias() = weighted.transpose() * rows_;
      normal_->equations.moment.noalias() = weighted.transpose() * right_hand_side_;
    });
    return normal_->equations;
  }

  /// sqrt(sum of w (a x - b)^2) for each right-hand side, given its solution as a column of `x`.
  [[nodiscard]] Eigen::VectorXd residual(const Eigen::MatrixXd& x) const {
    Eigen::MatrixXd misfit = -right_hand_side_;
    misfit.noalias() += rows_ * x;
    Eigen::VectorXd norms(misfit.cols());
    for (Eigen::Index column = 0; column < misfit.cols(); ++column)
      norms[column] = std::sqrt(weights_.dot(misfit.col(column).cwiseAbs2()));
    return norms;
  }

 private:
  struct lazy_normal_equations {
    std::once_flag built;
    normal_equations equations;
  };

  void require_consistent() const {
    const auto count = [](Eigen::Index n) { return std::to_string(n); };
    if (rows_.size() == 0 || right_hand_side_.cols() == 0)
      throw error("a least-squares problem of " + count(rows_.rows()) + " rows, " + count(rows_.cols()) +
                  " unknowns and " + count(right_hand_side_.cols()) + " right-hand sides is empty");
    if (right_hand_side_.rows() != rows_.rows() || weights_.size() != rows_.rows())
      throw error("a least-squares problem of " + count(rows_.rows()) + " rows has " + count(right_hand_side_.rows()) +
                  " right-hand values and " + count(weights_.size()) + " weights");
    for (Eigen::Index row = 0; row < rows_.rows(); ++row) {
      const auto finite = [row](const auto& matrix) {
        for (Eigen::Index column = 0; column < matrix.cols(); ++column)
          if (!std::isfinite(matrix(row, column))) return false;
        return true;
      };
      if (!finite(rows_) || !finite(right_hand_side_))
        throw error("row " + count(row) + " of a least-squares problem is not finite");
      if (!(weights_[row] >= 0.0 && std::isfinite(weights_[row])))
        throw error("row " + count(row) + " of a least-squares problem has weight " + std::to_string(weights_[row]) +
                    ": weights must be finite and not negative");
    }
  }

  row_matrix rows_;
  Eigen::MatrixXd right_hand_side_;
  Eigen::VectorXd weights_;
  std::shared_ptr<lazy_normal_equations> normal_ = std::make_shared<lazy_normal_equations>();
};

}  // namespace gonio
