#pragma once
/// Bodies of solve/gram.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/solve/gram.hpp>
#include <gonio/solve/normal_equations.hpp>
#include <gonio/solve/row_source.hpp>

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <concepts>

namespace gonio {

GONIO_INLINE normal_equations assemble(const row_source& rows, const Eigen::MatrixXd& right_hand_side,
                                       const Eigen::VectorXd& weights, thread_count threads) {
  const Eigen::Index k = rows.columns, r = right_hand_side.cols();
  const bool weighted = (weights.array() != 1.0).any();
  using sum_type = detail::product_sum<double>;
  const sum_type zero(k + r);
  const Eigen::MatrixXd all = sum_over_blocks(
                                  static_cast<std::size_t>(rows.rows), sum_type::block_rows, zero,
                                  [&](sum_type& sum, block range) {
                                    const auto begin = static_cast<Eigen::Index>(range.begin),
                                               count = static_cast<Eigen::Index>(range.size());
                                    auto equations = sum.rows(count);
                                    rows.read(range, equations.leftCols(k));
                                    equations.rightCols(r) = right_hand_side.middleRows(begin, count);
                                    if (weighted)
                                      for (Eigen::Index row = 0; row < count; ++row)
                                        equations.row(row) *= std::sqrt(weights[begin + row]);
                                    sum.add(count);
                                  },
                                  threads)
                                  .symmetric();
  return {all.topLeftCorner(k, k), all.topRightCorner(k, r), all.diagonal().tail(r)};
}

}  // namespace gonio
