#pragma once
/// Gram matrices of tall float matrices, accumulated in double.

#include <gonio/core/parallel.hpp>

#include <Eigen/Core>

#include <concepts>

namespace gonio {

/// A' A of a tall row-major n x k matrix of floats in double precision: products and sums are double, because the
/// last eigenvalues of a float Gram matrix are noise. O(n k^2 / 2) multiply-adds, 2 MB of scratch a
/// thread; same bytes for any number of threads.
template <class Derived>
requires(std::same_as<typename Derived::Scalar, float>&& bool(Derived::IsRowMajor)) [[nodiscard]] Eigen::MatrixXd
    gram(const Eigen::MatrixBase<Derived>& rows, thread_count threads = {}) {
  const Eigen::Index columns = rows.cols();
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(columns, columns);
  const Eigen::MatrixXd lower = sum_over_blocks(
      static_cast<std::size_t>(rows.rows()), 512, zero,
      [&](Eigen::MatrixXd& sum, block range) {
        // Transposed, a block of row-major rows is a column-major k x n matrix: the cast reads and writes in order.
        const auto begin = static_cast<Eigen::Index>(range.begin), count = static_cast<Eigen::Index>(range.size());
        const Eigen::MatrixXd part = rows.middleRows(begin, count).transpose().template cast<double>();
        sum.selfadjointView<Eigen::Lower>().rankUpdate(part);
      },
      threads);
  return lower.selfadjointView<Eigen::Lower>();
}

}  // namespace gonio
