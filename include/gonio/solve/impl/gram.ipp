#pragma once
/// Bodies of solve/gram.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/solve/gram.hpp>
#include <gonio/solve/normal_equations.hpp>
#include <gonio/solve/row_source.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <utility>

namespace gonio {

GONIO_INLINE normal_equations assemble(const row_source& rows, const Eigen::MatrixXd& right_hand_side,
                                       const Eigen::VectorXd& weights, thread_count threads) {
  // Sum (A b)'W(A b) over blocks of rows, right-hand sides as further columns.
  const Eigen::Index k = rows.columns, r = right_hand_side.cols();
  using sum_type = detail::product_sum<double>;
  const auto add_rows = [&](sum_type& sum, block range) {
    row_matrix read(range.size(), k);
    rows.read(range, read);
    for (Eigen::Index row = 0; row < range.size(); ++row) {  // each times the root of its weight
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

}  // namespace gonio
