#pragma once
/// Gram matrices of tall matrices, computed a block of rows at a time.

#include <gonio/core/parallel.hpp>
#include <gonio/solve/product_sum.hpp>

#include <Eigen/Core>

#include <concepts>

namespace gonio {

/// Returns A'A of a tall row-major n x k matrix of floats. n k (k + 1) floating-point operations. Any number of threads
/// gives the same bytes.
///
/// `Products` is the precision of the products and of their sums over 128 rows; these sums are added in double. `float`
/// takes about 0.6 times as long as `double`. On measured materials, it changes entries by up to 1e-7 of their columns'
/// lengths. docs/results/solvers.md shows the effect on each solver.
template <class Products = double, class Derived>
requires(std::same_as<typename Derived::Scalar, float>&& bool(Derived::IsRowMajor)) [[nodiscard]] Eigen::MatrixXd
    gram(const Eigen::MatrixBase<Derived>& rows, thread_count threads = {}) {
  using sum_type = detail::product_sum<Products>;
  using float_rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Ref<const float_rows, 0, Eigen::OuterStride<>> all = rows.derived();
  const sum_type zero(all.cols());
  return sum_over_blocks(
             all.rows(), sum_type::block_rows, zero,
             [&](sum_type& sum, block range) {
               for (Eigen::Index i = range.begin; i < range.end; ++i)
                 sum.put(i - range.begin, all.data() + i * all.outerStride(), all.cols());
               sum.add(range.size());
             },
             threads)
      .symmetric();
}

}  // namespace gonio
