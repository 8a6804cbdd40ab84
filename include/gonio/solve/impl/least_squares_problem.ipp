#pragma once
/// Bodies of solve/least_squares_problem.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/solve/least_squares_problem.hpp>
#include <gonio/solve/normal_equations.hpp>
#include <gonio/solve/product_sum.hpp>
#include <gonio/solve/row_source.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

namespace detail {

/// Assembles the normal equations of weighted rows. [A, b], scaled by sqrt(w), gives Q, A'Wb and b'Wb as blocks of one
/// Gram matrix. All in double; reads A once; n (k + r)^2 operations for n rows, k columns and r right-hand sides. Any
/// number of threads gives the same bytes. Throws gonio::error if the result is not finite.
[[nodiscard]] GONIO_INLINE normal_equations assemble(const row_source& rows, const Eigen::MatrixXd& right_hand_side,
                                                     const Eigen::VectorXd& weights, thread_count threads) {
  // Sum [A b]'W [A b] over blocks of rows.
  const Eigen::Index k = rows.columns, r = right_hand_side.cols();
  using sum_type = product_sum<double>;
  const auto add_rows = [&](sum_type& sum, block range) {
    row_matrix read(range.size(), k);
    rows.read(range, read);
    for (Eigen::Index row = 0; row < range.size(); ++row) {  // each times the square root of its weight
      const double root = std::sqrt(weights[range.begin + row]);
      sum.put(row, read.data() + row * k, k, root);
      for (Eigen::Index column = 0; column < r; ++column)
        sum(row, k + column) = root * right_hand_side(range.begin + row, column);
    }
    sum.add(range.size());
  };
  const Eigen::MatrixXd all =
      sum_over_blocks(rows.rows, sum_type::block_rows, sum_type(k + r), add_rows, threads).symmetric();

  // Split the sum into A'WA, A'Wb and b'Wb (Noell et al. 2014, Eq. 10).
  Eigen::MatrixXd gram(k, k), rhs(k, r);
  Eigen::VectorXd rhs_squared_norm(r);
  for (Eigen::Index column = 0; column < k; ++column) std::copy_n(&all(0, column), k, &gram(0, column));
  for (Eigen::Index column = 0; column < r; ++column) {
    std::copy_n(&all(0, k + column), k, &rhs(0, column));
    rhs_squared_norm[column] = all(k + column, k + column);
  }
  return {std::move(gram), std::move(rhs), std::move(rhs_squared_norm)};
}

}  // namespace detail

GONIO_INLINE row_matrix least_squares_problem::rows() const {
  row_matrix gathered(equations(), unknowns());
  for_each_row_block([&](block range, const row_matrix& part) {
    std::copy_n(part.data(), part.size(), gathered.data() + range.begin * gathered.cols());
  });
  return gathered;
}

GONIO_INLINE Eigen::Index least_squares_problem::observations() const {
  Eigen::Index count = 0;
  for (Eigen::Index row = 0; row < equations(); ++row) count += weights()[row] > 0.0 ? 1 : 0;
  return count;
}

GONIO_INLINE row_matrix least_squares_problem::weighted_rows() const {
  row_matrix gathered(observations(), unknowns());
  Eigen::Index filled = 0;
  for_each_row_block([&](block range, const row_matrix& part) {
    for (Eigen::Index row = 0; row < part.rows(); ++row) {
      const double weight = weights()[range.begin + row];
      if (!(weight > 0.0)) continue;
      for (Eigen::Index column = 0; column < part.cols(); ++column)
        gathered(filled, column) = std::sqrt(weight) * part(row, column);
      ++filled;
    }
  });
  return gathered;
}

GONIO_INLINE Eigen::MatrixXd least_squares_problem::weighted_right_hand_side() const {
  Eigen::MatrixXd gathered(observations(), right_hand_side().cols());
  Eigen::Index filled = 0;
  for (Eigen::Index row = 0; row < equations(); ++row)
    if (weights()[row] > 0.0) {
      for (Eigen::Index column = 0; column < gathered.cols(); ++column)
        gathered(filled, column) = std::sqrt(weights()[row]) * right_hand_side()(row, column);
      ++filled;
    }
  return gathered;
}

GONIO_INLINE const normal_equations& least_squares_problem::normal() const {
  std::call_once(normal_->built, [&] {
    if (whole_)
      normal_->equations = whole_->normal().subset(*columns_);
    else
      normal_->equations = assemble_finite();
  });
  return *normal_->equations;
}

GONIO_INLINE least_squares_problem least_squares_problem::subset(std::span<const Eigen::Index> columns) const {
  least_squares_problem part(*this);
  part.whole_ = std::make_shared<const least_squares_problem>(*this);
  part.normal_ = std::make_shared<lazy_normal_equations>();
  std::vector<Eigen::Index> chosen(columns.begin(), columns.end());
  for (Eigen::Index& column : chosen) {
    if (column < 0 || column >= unknowns())
      gonio::refuse({"a least-squares problem of ", unknowns(), " unknowns has no column ", column});
    if (columns_) column = (*columns_)[column];
  }
  if (chosen.empty()) gonio::refuse("a least-squares problem needs at least one column");
  // A subset of a subset refers to the outermost problem, so columns are numbered in that problem.
  if (whole_) part.whole_ = whole_;
  part.columns_ = std::move(chosen);
  return part;
}

GONIO_INLINE Eigen::VectorXd least_squares_problem::residual(const Eigen::MatrixXd& x) const {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(x.cols());
  Eigen::VectorXd norms = sum_over_blocks(
      equations(), block_rows, zero,
      [&](Eigen::VectorXd& sum, block range) {
        const row_matrix part = read(range);
        for (Eigen::Index row = 0; row < part.rows(); ++row) {
          const Eigen::Index at = range.begin + row;
          for (Eigen::Index column = 0; column < x.cols(); ++column) {
            const double misfit = dot(&part(row, 0), &x(0, column), x.rows()) - right_hand_side()(at, column);
            sum[column] += weights()[at] * misfit * misfit;
          }
        }
      },
      threads_);
  for (Eigen::Index column = 0; column < norms.size(); ++column) norms[column] = std::sqrt(norms[column]);
  return norms;
}

GONIO_INLINE least_squares_problem::stored::stored(row_source source, Eigen::MatrixXd b, Eigen::VectorXd w)
    : rows(std::move(source)), right_hand_side(std::move(b)), weights(std::move(w)) {
  if (weights.size() == 0) weights = Eigen::VectorXd::Ones(rows.rows);
  if (rows.rows == 0 || rows.columns == 0 || right_hand_side.cols() == 0)
    gonio::refuse({"a least-squares problem of ", rows.rows, " rows, ", rows.columns, " unknowns and ",
                   right_hand_side.cols(), " right-hand sides is empty"});
  if (right_hand_side.rows() != rows.rows || weights.size() != rows.rows)
    gonio::refuse({"a least-squares problem of ", rows.rows, " rows has ", right_hand_side.rows(),
                   " right-hand values and ", weights.size(), " weights"});
  for (Eigen::Index row = 0; row < rows.rows; ++row) {
    for (Eigen::Index column = 0; column < right_hand_side.cols(); ++column)
      if (!std::isfinite(right_hand_side(row, column)))
        gonio::refuse({"row ", row, " of a least-squares problem is not finite on its right-hand side"});
    if (!(weights[row] >= 0.0 && std::isfinite(weights[row])))
      gonio::refuse({"row ", row, " of a least-squares problem has weight ", weights[row],
                     ": weights must be finite and not negative"});
  }
}

GONIO_INLINE row_matrix least_squares_problem::read(block range) const {
  row_matrix all(range.size(), equations_->rows.columns);
  equations_->rows.read(range, all);
  // Check the sum of squares first: if it is finite, all its terms are, and it takes one vectorised pass. If the sum
  // overflows, the terms may still be finite.
  if (!std::isfinite(dot(all.data(), all.data(), all.size()))) require_finite(all, range.begin);
  if (!columns_) return all;
  row_matrix chosen(all.rows(), unknowns());
  for (Eigen::Index row = 0; row < chosen.rows(); ++row)
    for (Eigen::Index column = 0; column < chosen.cols(); ++column) chosen(row, column) = all(row, (*columns_)[column]);
  return chosen;
}

GONIO_INLINE void least_squares_problem::require_finite(const row_matrix& part, Eigen::Index first_row) {
  for (Eigen::Index row = 0; row < part.rows(); ++row)
    for (Eigen::Index column = 0; column < part.cols(); ++column)
      if (!std::isfinite(part(row, column)))
        gonio::refuse({"row ", first_row + row, " of a least-squares problem is not finite in column ", column});
}

GONIO_INLINE normal_equations least_squares_problem::assemble_finite() const {
  try {
    normal_equations normal = detail::assemble(equations_->rows, right_hand_side(), weights(), threads_);
    require_no_underflow(normal);
    return normal;
  } catch (const error&) {
    read_all();  // throws an error that names the row, which the sums cannot
    throw;
  }
}

GONIO_INLINE void least_squares_problem::require_no_underflow(const normal_equations& normal) const {
  // If a sum of squares is at least this large, it loses less by underflow than by rounding.
  const double least = std::numeric_limits<double>::min() * static_cast<double>(equations());
  const auto refuse_tiny = [](const std::string& what) {
    gonio::refuse({what, " of a least-squares problem is too small: its squares underflow double precision. ",
                   "Scale it by a power of ten"});
  };
  for (Eigen::Index column = 0; column < right_hand_side().cols(); ++column)
    for (Eigen::Index row = 0; row < equations() && normal.rhs_squared_norm()[column] < least; ++row)
      if (weights()[row] > 0.0 && right_hand_side()(row, column) != 0.0)
        refuse_tiny("right-hand side " + std::to_string(column));
  bool is_tiny = false;
  for (Eigen::Index k = 0; k < normal.unknowns(); ++k) is_tiny = is_tiny || normal.gram()(k, k) < least;
  if (!is_tiny) return;
  for_each_row_block([&](block range, const row_matrix& part) {
    for (Eigen::Index row = 0; row < part.rows(); ++row)
      for (Eigen::Index column = 0; column < part.cols(); ++column)
        if (normal.gram()(column, column) < least && part(row, column) != 0.0 && weights()[range.begin + row] > 0.0)
          refuse_tiny("column " + std::to_string(column));
  });
}

}  // namespace gonio
