#pragma once
/// Sums of outer products: the loop that Gram matrices, A'A and A A', and factorisations spend their time in.
/// Goto and van de Geijn, "Anatomy of High-Performance Matrix Multiplication" (doi:10.1145/1356052.1356053).

#include <gonio/core/vector_kernels.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace gonio {

namespace detail {

/// Sums A'A over blocks of the rows of A: products and their sums within a block are `Scalar`, blocks are added in
/// double. On a row-major block A'A is a sum of outer products of contiguous pieces: a tile of the result stays in
/// registers while it reads, row by row, the pieces of its rows and of its columns, which are copied next to each
/// other.
template <class Scalar>
class product_sum {
 public:
  static constexpr Eigen::Index block_rows = 128;
  /// Two vector registers by six columns: twelve sums in flight, which hide the latency of a fused multiply-add.
  static constexpr Eigen::Index tile_rows = 2 * std::max(EIGEN_MAX_ALIGN_BYTES, 16) / Eigen::Index{sizeof(Scalar)};
  static constexpr Eigen::Index tile_columns = 6;

  /// Takes at most `rows` rows at a time.
  explicit product_sum(Eigen::Index columns, Eigen::Index rows = block_rows) : columns_(columns) {
    const Eigen::Index length = whole_tiles(columns, tile_rows), reach = whole_tiles(columns, tile_columns);
    buffer_.resize(rows, std::max(length, reach));
    panel_.resize(rows, std::min(panel_columns, reach));
    left_.resize(rows, tile_rows);
    sum_.resize(length, reach);
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
    // In panels of columns, which are copied so that a tile reads what lies together.
    for (Eigen::Index first = 0; first < columns_; first += panel_columns) {
      pack(count, first, std::min(panel_columns, sum_.cols() - first), panel_);
      for (Eigen::Index i = first / tile_rows * tile_rows; i < columns_; i += tile_rows) {
        pack(count, i, tile_rows, left_);
        const Eigen::Index end = std::min({first + panel_columns, i + tile_rows, columns_});
        for (Eigen::Index j = first; j < end; j += tile_columns) add_tile(count, i, j, panel_.data() + (j - first));
      }
    }
  }

  product_sum& operator+=(const product_sum& other) {
    add_scaled(1.0, other.sum_.data(), sum_.data(), sum_.size());
    return *this;
  }

  /// Takes the lower triangle of A'A from that of a matrix, its columns `stride` numbers apart.
  void subtract_lower_from(double* matrix, Eigen::Index stride) const {
    for (Eigen::Index j = 0; j < columns_; ++j) add_scaled(-1.0, &sum_(j, j), matrix + j * (stride + 1), columns_ - j);
  }

  /// A'A, both triangles.
  [[nodiscard]] Eigen::MatrixXd symmetric() const {
    Eigen::MatrixXd full(columns_, columns_);
    for (Eigen::Index j = 0; j < columns_; ++j)
      for (Eigen::Index i = j; i < columns_; ++i) full(i, j) = full(j, i) = sum_(i, j);
    return full;
  }

 private:
  static constexpr Eigen::Index panel_columns = 18 * tile_columns;
  using piece = Eigen::Array<Scalar, tile_rows, 1>;

  using row_major = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  [[nodiscard]] static Eigen::Index whole_tiles(Eigen::Index count, Eigen::Index tile) {
    return (count + tile - 1) / tile * tile;
  }

  /// Copies some columns of the buffer's first `count` rows.
  void pack(Eigen::Index count, Eigen::Index first, Eigen::Index columns, row_major& to) const {
    for (Eigen::Index r = 0; r < count; ++r)
      std::copy_n(buffer_.data() + r * buffer_.cols() + first, columns, to.data() + r * to.cols());
  }

  void add_tile(Eigen::Index count, Eigen::Index i, Eigen::Index j, const Scalar* right) {
    add_tile(count, &sum_(i, j), right, std::make_index_sequence<tile_columns>());
  }

  /// A pack instead of loops over the columns: without unrolling, the products would live in memory.
  template <std::size_t... Column>
  void add_tile(Eigen::Index count, double* sum, const Scalar* right, std::index_sequence<Column...> /*columns*/) {
    const Scalar* left = left_.data();
    std::array<piece, tile_columns> products{((void)Column, piece(piece::Zero()))...};
    for (Eigen::Index r = 0; r < count; ++r, left += tile_rows, right += panel_.cols()) {
      const piece rows = Eigen::Map<const piece>(left);
      ((products[Column] += rows * right[Column]), ...);
    }
    const auto add_column = [&](const piece& column, double* to) {
      for (Eigen::Index r = 0; r < tile_rows; ++r) to[r] += double{column[r]};
    };
    (add_column(products[Column], sum + Column * sum_.rows()), ...);
  }

  Eigen::Index columns_;
  row_major buffer_, panel_, left_;
  Eigen::MatrixXd sum_;
};

}  // namespace detail

}  // namespace gonio
