#pragma once
/// Weighted linear least squares: minimise the sum over rows of w (a x - b)^2 for one or more right-hand
/// sides b. Noell, Koehler and Stricker 2014, Eq. 7-10.

#include <gonio/core/error.hpp>
#include <gonio/solve/gram.hpp>
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

/// The equations of a least-squares problem, tall (a million rows by 99) or wide (5 rows by 300). The
/// normal equations are built once, on demand, in double precision; asking for them is thread safe, and
/// copies share them. The rows are read where they are (`row_source`) and not kept.
class least_squares_problem {
 public:
  /// `rows` is n x k, `right_hand_side` n x r, `weights` n (all 1 if empty). Throws gonio::error if the
  /// sizes do not match, the problem is empty, a number is not finite or a weight is negative, naming the
  /// first offending row.
  least_squares_problem(row_matrix rows, Eigen::MatrixXd right_hand_side, Eigen::VectorXd weights = {})
      : least_squares_problem(rows_of(std::move(rows)), std::move(right_hand_side), std::move(weights)) {
    read_all();
  }

  /// The same from rows that are read when they are needed. Whatever reads them throws gonio::error naming the row and
  /// the column (of the whole, for a subset) of a number that is not finite: every member function but sizes,
  /// right-hand side and weights.
  least_squares_problem(row_source rows, Eigen::MatrixXd right_hand_side, Eigen::VectorXd weights = {},
                        thread_count threads = {})
      : equations_(std::make_shared<const stored>(std::move(rows), std::move(right_hand_side), std::move(weights))),
        threads_(threads) {}

  /// b: n x r.
  [[nodiscard]] const Eigen::MatrixXd& right_hand_side() const noexcept { return equations_->right_hand_side; }
  /// The diagonal of W: n.
  [[nodiscard]] const Eigen::VectorXd& weights() const noexcept { return equations_->weights; }

  [[nodiscard]] Eigen::Index equations() const noexcept { return equations_->rows.rows; }
  [[nodiscard]] Eigen::Index unknowns() const noexcept {
    return columns_ ? static_cast<Eigen::Index>(columns_->size()) : equations_->rows.columns;
  }

  /// A, gathered: n x k, in double precision. For small problems.
  [[nodiscard]] row_matrix rows() const {
    row_matrix gathered(equations(), unknowns());
    for_each_row_block([&](block range, const row_matrix& part) {
      gathered.middleRows(static_cast<Eigen::Index>(range.begin), part.rows()) = part;
    });
    return gathered;
  }

  /// How many rows have a positive weight: all others say nothing.
  [[nodiscard]] Eigen::Index observations() const { return (weights().array() > 0.0).count(); }

  /// W^(1/2) A, gathered from the rows of positive weight: observations() x k. For small problems.
  [[nodiscard]] row_matrix weighted_rows() const {
    row_matrix gathered(observations(), unknowns());
    Eigen::Index filled = 0;
    for_each_row_block([&](block range, const row_matrix& part) {
      for (Eigen::Index row = 0; row < part.rows(); ++row) {
        const double weight = weights()[static_cast<Eigen::Index>(range.begin) + row];
        if (weight > 0.0) gathered.row(filled++) = std::sqrt(weight) * part.row(row);
      }
    });
    return gathered;
  }

  /// W^(1/2) b of the same rows: observations() x r.
  [[nodiscard]] Eigen::MatrixXd weighted_right_hand_side() const {
    Eigen::MatrixXd gathered(observations(), right_hand_side().cols());
    Eigen::Index filled = 0;
    for (Eigen::Index row = 0; row < equations(); ++row)
      if (weights()[row] > 0.0) gathered.row(filled++) = std::sqrt(weights()[row]) * right_hand_side().row(row);
    return gathered;
  }

  /// O(n k^2) the first time; O(k^2) for a subset whose whole has them already. Throws gonio::error naming the first
  /// row that is not finite.
  [[nodiscard]] const normal_equations& normal() const {
    std::call_once(normal_->built, [&] {
      if (whole_)
        normal_->equations = whole_->normal().subset(*columns_);
      else
        normal_->equations = assemble_finite();
    });
    return *normal_->equations;
  }

  /// The same equations in some of the unknowns, in the order given. Its normal equations are a submatrix of the
  /// whole's.
  [[nodiscard]] least_squares_problem subset(std::span<const Eigen::Index> columns) const {
    least_squares_problem part(*this);
    part.whole_ = std::make_shared<const least_squares_problem>(*this);
    part.normal_ = std::make_shared<lazy_normal_equations>();
    std::vector<Eigen::Index> chosen(columns.begin(), columns.end());
    for (Eigen::Index& column : chosen) {
      if (column < 0 || column >= unknowns())
        throw error("a least-squares problem of " + std::to_string(unknowns()) + " unknowns has no column " +
                    std::to_string(column));
      if (columns_) column = (*columns_)[static_cast<std::size_t>(column)];
    }
    if (chosen.empty()) throw error("a least-squares problem needs at least one column");
    // Columns count from the whole that has no whole itself, so that subsets of subsets do not nest.
    if (whole_) part.whole_ = whole_;
    part.columns_ = std::move(chosen);
    return part;
  }

  /// sqrt(sum of w (a x - b)^2) for each right-hand side, given its solution as a column of `x`. Reads the rows: O(n k
  /// r). Throws gonio::error if one is not finite.
  [[nodiscard]] Eigen::VectorXd residual(const Eigen::MatrixXd& x) const {
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(x.cols());
    const Eigen::VectorXd squares = sum_over_blocks(
        static_cast<std::size_t>(equations()), block_rows, zero,
        [&](Eigen::VectorXd& sum, block range) {
          const auto begin = static_cast<Eigen::Index>(range.begin), count = static_cast<Eigen::Index>(range.size());
          const row_matrix part = read(range);
          for (Eigen::Index column = 0; column < x.cols(); ++column) {
            const Eigen::VectorXd misfit = part * x.col(column) - right_hand_side().col(column).segment(begin, count);
            sum[column] += weights().segment(begin, count).dot(misfit.cwiseAbs2());
          }
        },
        threads_);
    return squares.cwiseSqrt();
  }

  /// Calls `use(range, rows)` for blocks of A in double precision, in order, one after the other.
  template <class Use>
  void for_each_row_block(Use&& use) const {
    const auto n = static_cast<std::size_t>(equations());
    for (std::size_t begin = 0; begin < n; begin += block_rows) {
      const block range{begin, std::min(n, begin + block_rows)};
      use(range, read(range));
    }
  }

 private:
  static constexpr std::size_t block_rows = 1024;

  struct stored {
    row_source rows;
    Eigen::MatrixXd right_hand_side;
    Eigen::VectorXd weights;

    stored(row_source source, Eigen::MatrixXd b, Eigen::VectorXd w)
        : rows(std::move(source)), right_hand_side(std::move(b)), weights(std::move(w)) {
      if (weights.size() == 0) weights = Eigen::VectorXd::Ones(rows.rows);
      const auto text = [](Eigen::Index n) { return std::to_string(n); };
      if (rows.rows == 0 || rows.columns == 0 || right_hand_side.cols() == 0)
        throw error("a least-squares problem of " + text(rows.rows) + " rows, " + text(rows.columns) +
                    " unknowns and " + text(right_hand_side.cols()) + " right-hand sides is empty");
      if (right_hand_side.rows() != rows.rows || weights.size() != rows.rows)
        throw error("a least-squares problem of " + text(rows.rows) + " rows has " + text(right_hand_side.rows()) +
                    " right-hand values and " + text(weights.size()) + " weights");
      for (Eigen::Index row = 0; row < rows.rows; ++row) {
        for (Eigen::Index column = 0; column < right_hand_side.cols(); ++column)
          if (!std::isfinite(right_hand_side(row, column)))
            throw error("row " + text(row) + " of a least-squares problem is not finite on its right-hand side");
        if (!(weights[row] >= 0.0 && std::isfinite(weights[row])))
          throw error("row " + text(row) + " of a least-squares problem has weight " + std::to_string(weights[row]) +
                      ": weights must be finite and not negative");
      }
    }
  };

  struct lazy_normal_equations {
    std::once_flag built;
    std::optional<normal_equations> equations;
  };

  /// The one place where rows come in.
  [[nodiscard]] row_matrix read(block range) const {
    row_matrix all(static_cast<Eigen::Index>(range.size()), equations_->rows.columns);
    equations_->rows.read(range, all);
    // A finite sum has finite terms, and is one vectorised pass; terms of a sum that overflows may be finite too.
    if (!std::isfinite(all.sum())) require_finite(all, range.begin);
    if (!columns_) return all;
    row_matrix chosen(all.rows(), unknowns());
    for (Eigen::Index column = 0; column < chosen.cols(); ++column)
      chosen.col(column) = all.col((*columns_)[static_cast<std::size_t>(column)]);
    return chosen;
  }

  static void require_finite(const row_matrix& part, std::size_t first_row) {
    for (Eigen::Index row = 0; row < part.rows(); ++row)
      for (Eigen::Index column = 0; column < part.cols(); ++column)
        if (!std::isfinite(part(row, column)))
          throw error("row " + std::to_string(first_row + static_cast<std::size_t>(row)) +
                      " of a least-squares problem is not finite in column " + std::to_string(column));
  }

  void read_all() const {
    for_each_row_block([](block, const row_matrix&) {});
  }

  [[nodiscard]] normal_equations assemble_finite() const {
    try {
      return assemble(equations_->rows, right_hand_side(), weights(), threads_);
    } catch (const error&) {
      read_all();  // names the row, which the sums have forgotten
      throw;
    }
  }

  std::shared_ptr<const stored> equations_;
  thread_count threads_;
  std::optional<std::vector<Eigen::Index>> columns_;    // of the whole; absent: all
  std::shared_ptr<const least_squares_problem> whole_;  // whose normal equations hold ours
  std::shared_ptr<lazy_normal_equations> normal_ = std::make_shared<lazy_normal_equations>();
};

static_assert(quadratic_problem<least_squares_problem>);

}  // namespace gonio
