#pragma once
/// Weighted linear least squares: minimise the sum over rows of w (a x - b)^2 for one or more right-hand
/// sides b. Noell, Koehler and Stricker 2014, Eq. 7-10.

#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/solve/normal_equations.hpp>
#include <gonio/solve/row_source.hpp>

#include <Eigen/Core>

#include <cmath>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

/// The equations of a least-squares problem, tall (a million rows by 99) or wide (5 rows by 300). The normal equations
/// are built once, on demand, in double precision. Requesting them is thread safe, and copies share them. The rows are
/// read in place (`row_source`) and not stored.
class least_squares_problem {
 public:
  /// `rows` is n x k, `right_hand_side` is n x r, and `weights` has n numbers (all 1 if empty). Throws gonio::error if
  /// the sizes do not match, the problem is empty, a number is not finite or a weight is negative; for a number, the
  /// message names the first such row.
  least_squares_problem(row_matrix rows, Eigen::MatrixXd right_hand_side, Eigen::VectorXd weights = {})
      : least_squares_problem(rows_of(std::move(rows)), std::move(right_hand_side), std::move(weights)) {
    read_all();
  }

  /// Takes rows that are read on demand. All member functions except those for sizes, right-hand side and weights read
  /// them, and throw gonio::error for a number that is not finite. The message names the row and the column; for a
  /// subset, the column of the original problem.
  least_squares_problem(row_source rows, Eigen::MatrixXd right_hand_side, Eigen::VectorXd weights = {},
                        thread_count threads = {})
      : equations_(std::make_shared<const stored>(std::move(rows), std::move(right_hand_side), std::move(weights))),
        threads_(threads) {}

  /// Returns b: n x r.
  [[nodiscard]] const Eigen::MatrixXd& right_hand_side() const noexcept { return equations_->right_hand_side; }
  /// Returns the n weights: the diagonal of W.
  [[nodiscard]] const Eigen::VectorXd& weights() const noexcept { return equations_->weights; }

  [[nodiscard]] Eigen::Index equations() const noexcept { return equations_->rows.rows; }
  [[nodiscard]] Eigen::Index unknowns() const noexcept {
    return columns_ ? std::ssize(*columns_) : equations_->rows.columns;
  }

  /// Returns A as a copy: n x k, in double precision. For small problems.
  [[nodiscard]] row_matrix rows() const;

  /// Returns the number of rows of positive weight.
  [[nodiscard]] Eigen::Index observations() const;

  /// Returns W^(1/2) A for the rows of positive weight: observations() x k. For small problems.
  [[nodiscard]] row_matrix weighted_rows() const;

  /// Returns W^(1/2) b for the rows of positive weight: observations() x r.
  [[nodiscard]] Eigen::MatrixXd weighted_right_hand_side() const;

  /// Returns the normal equations. O(n k^2) the first time; O(k^2) for a subset of a problem that already has them.
  /// Throws gonio::error naming the first row that is not finite, or a column or right-hand side so small that its
  /// squares underflow (numbers of about 1e-154 and below).
  [[nodiscard]] const normal_equations& normal() const;

  /// Returns the problem with only some of the unknowns, in the given order. Its normal equations are a submatrix of
  /// those of this problem.
  [[nodiscard]] least_squares_problem subset(std::span<const Eigen::Index> columns) const;

  /// Returns sqrt(sum of w (a x - b)^2) for each right-hand side, given its solution as a column of `x`. Reads the
  /// rows: O(n k r). Throws gonio::error if a row is not finite.
  [[nodiscard]] Eigen::VectorXd residual(const Eigen::MatrixXd& x) const;

  /// Calls `use(range, rows)` for consecutive blocks of A in double precision, one after the other.
  template <class Use>
  void for_each_row_block(Use&& use) const {
    const Eigen::Index n = equations();
    for (Eigen::Index begin = 0; begin < n; begin += block_rows) {
      const block range{begin, std::min(n, begin + block_rows)};
      use(range, read(range));
    }
  }

 private:
  static constexpr Eigen::Index block_rows = 1024;

  struct stored {
    row_source rows;
    Eigen::MatrixXd right_hand_side;
    Eigen::VectorXd weights;

    stored(row_source source, Eigen::MatrixXd b, Eigen::VectorXd w);
  };

  struct lazy_normal_equations {
    std::once_flag built;
    std::optional<normal_equations> equations;
  };

  /// Returns the rows of a range. All reading goes through this function.
  [[nodiscard]] row_matrix read(block range) const;

  static void require_finite(const row_matrix& part, Eigen::Index first_row);

  void read_all() const {
    for_each_row_block([](block, const row_matrix&) {});
  }

  [[nodiscard]] normal_equations assemble_finite() const;

  /// Throws gonio::error if the sum of squares of a column or right-hand side underflows although it is not zero. The
  /// message names the column or right-hand side.
  void require_no_underflow(const normal_equations& normal) const;

  std::shared_ptr<const stored> equations_;
  thread_count threads_;
  std::optional<std::vector<Eigen::Index>> columns_;  // columns of `whole_`; absent if all
  std::shared_ptr<const least_squares_problem>
      whole_;  // of a subset: the original problem, whose normal equations the subset uses
  std::shared_ptr<lazy_normal_equations> normal_ = std::make_shared<lazy_normal_equations>();
};

static_assert(quadratic_problem<least_squares_problem>);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/least_squares_problem.ipp>
#endif
