#pragma once
/// Gram matrices of tall matrices, a block of rows at a time: Q = A'WA and A'Wb of Noell et al. 2014, Eq. 10.

#include <gonio/core/parallel.hpp>
#include <gonio/solve/normal_equations.hpp>
#include <gonio/solve/row_source.hpp>
#include <gonio/solve/vector_kernels.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>

namespace gonio {

namespace detail {

/// Sums A'A over blocks of the rows of A: products and their sums within a block are `Scalar`, blocks are added in
/// double. A block lies row-major in a buffer whose row length is a multiple of the tile, so that a tile of the result
/// stays in registers while it reads the rows once, without packing: on a row-major block A'A is a sum of outer
/// products of contiguous pieces.
template <class Scalar>
class product_sum {
 public:
  static constexpr Eigen::Index block_rows = 128;

  explicit product_sum(Eigen::Index columns)
      : columns_(columns), length_((columns + tile_rows - 1) / tile_rows * tile_rows) {
    const Eigen::Index reach = (columns + tile_columns - 1) / tile_columns * tile_columns;
    // An odd number of tiles from row to row: a power of two would put a tile's piece of every row into the same few
    // sets of the cache.
    const Eigen::Index tiles = (std::max(length_, reach) + tile_rows - 1) / tile_rows;
    buffer_.resize(block_rows, (tiles | 1) * tile_rows);
    sum_.resize(length_, reach);
    std::fill_n(buffer_.data(), buffer_.size(), Scalar(0));
    std::fill_n(sum_.data(), sum_.size(), 0.0);
  }

  /// Where the next `count` rows, at most block_rows, belong.
  [[nodiscard]] auto rows(Eigen::Index count) { return buffer_.topLeftCorner(count, columns_); }

  /// One of them, contiguous.
  [[nodiscard]] Scalar* row(Eigen::Index number) { return buffer_.data() + number * buffer_.cols(); }
  /// From one to the next.
  [[nodiscard]] Eigen::Index stride() const { return buffer_.cols(); }

  /// Adds the products of the first `count` rows of the buffer.
  void add(Eigen::Index count) {
    // In panels of columns, whose part of the buffer stays in the cache.
    constexpr Eigen::Index panel = 16 * tile_columns;
    for (Eigen::Index first = 0; first < columns_; first += panel)
      for (Eigen::Index i = first / tile_rows * tile_rows; i < columns_; i += tile_rows)
        for (Eigen::Index j = first; j < std::min({first + panel, i + tile_rows, columns_}); j += tile_columns)
          add_tile(count, i, j);
  }

  product_sum& operator+=(const product_sum& other) {
    add_scaled(1.0, other.sum_.data(), sum_.data(), sum_.size());
    return *this;
  }

  /// A'A, both triangles.
  [[nodiscard]] Eigen::MatrixXd symmetric() const {
    Eigen::MatrixXd full(columns_, columns_);
    for (Eigen::Index j = 0; j < columns_; ++j)
      for (Eigen::Index i = j; i < columns_; ++i) full(i, j) = full(j, i) = sum_(i, j);
    return full;
  }

 private:
  /// Two vector registers by six columns: twelve sums in flight, which hide the latency of a fused multiply-add.
  static constexpr Eigen::Index tile_rows = 2 * std::max(EIGEN_MAX_ALIGN_BYTES, 16) / Eigen::Index{sizeof(Scalar)};
  static constexpr Eigen::Index tile_columns = 6;
  using piece = Eigen::Array<Scalar, tile_rows, 1>;

  void add_tile(Eigen::Index count, Eigen::Index i, Eigen::Index j) {
    std::array<piece, tile_columns> products;
    for (piece& column : products) column.setZero();
    const Eigen::Index stride = buffer_.outerStride();
    const Scalar* row = buffer_.data();
    for (Eigen::Index r = 0; r < count; ++r, row += stride) {
      const piece left = Eigen::Map<const piece>(row + i);
      for (Eigen::Index c = 0; c < tile_columns; ++c) products[c] += left * row[j + c];
    }
    for (Eigen::Index c = 0; c < tile_columns; ++c)
      sum_.col(j + c).segment(i, tile_rows).array() += products[c].template cast<double>();
  }

  Eigen::Index columns_;
  Eigen::Index length_;
  Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> buffer_;
  Eigen::MatrixXd sum_;
};

}  // namespace detail

/// A'A of a tall row-major n x k matrix of floats. n k (k + 1) floating-point operations; same bytes for any number of
/// threads.
///
/// `Products` is the precision of the products and of their sums over 128 rows; these sums are added in double. With
/// `float` it takes about 0.6 times as long, and on measured materials entries are off by up to 1e-7 of their columns'
/// lengths (docs/results/solvers.md has what that does to each solver).
template <class Products = double, class Derived>
requires(std::same_as<typename Derived::Scalar, float>&& bool(Derived::IsRowMajor)) [[nodiscard]] Eigen::MatrixXd
    gram(const Eigen::MatrixBase<Derived>& rows, thread_count threads = {}) {
  using sum_type = detail::product_sum<Products>;
  const sum_type zero(rows.cols());
  return sum_over_blocks(
             rows.rows(), sum_type::block_rows, zero,
             [&](sum_type& sum, block range) {
               const Eigen::Index begin = range.begin, count = range.size();
               sum.rows(count) = rows.middleRows(begin, count).template cast<Products>();
               sum.add(count);
             },
             threads)
      .symmetric();
}

/// The normal equations of weighted rows: A and b side by side, scaled by sqrt(w), give Q, A'Wb and b'Wb as blocks of
/// one Gram matrix. All in double; reads A once; n (k + r)^2 operations; same bytes for any number of threads. Throws
/// gonio::error if the result is not finite.
[[nodiscard]] normal_equations assemble(const row_source& rows, const Eigen::MatrixXd& right_hand_side,
                                        const Eigen::VectorXd& weights, thread_count threads = {});

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/gram.ipp>
#endif
