#pragma once
/// Sums of outer products: the inner loop of Gram matrices, A'A and A A'.
/// Goto and van de Geijn, "Anatomy of High-Performance Matrix Multiplication" (doi:10.1145/1356052.1356053).

#include <gonio/core/vector_kernels.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace gonio {

namespace detail {

/// Sums A'A over blocks of the rows of A. Products and their sums within a block are `Scalar`; blocks are added in
/// double. A'A is a sum of outer products. A tile of A'A stays in registers while a block is read row by row. A block
/// is stored in strips of columns as wide as a cache line, each strip row by row. For a tile, the loop reads one strip,
/// and part of another strip, from end to end.
template <class Scalar>
class product_sum {
 public:
  static constexpr Eigen::Index block_rows = 128;
  static constexpr Eigen::Index strip_columns = 64 / Eigen::Index{sizeof(Scalar)};
  /// The number of columns whose sums fill eight vector registers, which hides the latency of a multiply-add.
  static constexpr Eigen::Index tile_columns = std::max(EIGEN_MAX_ALIGN_BYTES, 16) / 8;

  /// Makes room for blocks of at most `rows` rows.
  explicit product_sum(Eigen::Index columns, Eigen::Index rows = block_rows)
      : columns_(columns), strips_((columns + strip_columns - 1) / strip_columns), strip_size_(rows * strip_columns) {
    block_.resize(strips_ * strip_size_);
    sum_.resize(strips_ * strip_columns, strips_ * strip_columns);
    std::fill_n(block_.data(), block_.size(), Scalar(0));
    std::fill_n(sum_.data(), sum_.size(), 0.0);
  }

  /// Returns a number of the block, to be written before `add`.
  [[nodiscard]] Scalar& operator()(Eigen::Index row, Eigen::Index column) {
    return block_[column / strip_columns * strip_size_ + row * strip_columns + column % strip_columns];
  }

  /// Writes `count` numbers times a factor into a row of the block, starting at column 0.
  template <class Number>
  void put(Eigen::Index row, const Number* numbers, Eigen::Index count, Scalar factor = 1) {
    const Eigen::Index whole = count / strip_columns * strip_columns;
    Scalar* strip = block_.data() + row * strip_columns;
    for (Eigen::Index column = 0; column < whole; column += strip_columns, strip += strip_size_)
      for (Eigen::Index c = 0; c < strip_columns; ++c) strip[c] = factor * static_cast<Scalar>(numbers[column + c]);
    for (Eigen::Index c = 0; c < count - whole; ++c) strip[c] = factor * static_cast<Scalar>(numbers[whole + c]);
  }

  /// Adds the products of the first `rows` rows of the block.
  void add(Eigen::Index rows) {
    // Take few enough strips at a time for them to stay in the cache while all strips below are read.
    constexpr Eigen::Index together = 14;
    for (Eigen::Index first = 0; first < strips_; first += together)
      for (Eigen::Index left = first; left < strips_; ++left)
        for (Eigen::Index right = first; right < std::min(first + together, left + 1); ++right)
          for (Eigen::Index c = 0; c < strip_columns && right * strip_columns + c < columns_; c += tile_columns)
            add_tile(rows, left, right * strip_columns + c, std::make_index_sequence<tile_columns>());
  }

  product_sum& operator+=(const product_sum& other) {
    add_scaled(1.0, other.sum_.data(), sum_.data(), sum_.size());
    return *this;
  }

  /// Returns A'A, both triangles.
  [[nodiscard]] Eigen::MatrixXd symmetric() const {
    Eigen::MatrixXd full(columns_, columns_);
    for (Eigen::Index j = 0; j < columns_; ++j)
      for (Eigen::Index i = j; i < columns_; ++i) full(i, j) = full(j, i) = sum_(i, j);
    return full;
  }

 private:
  using piece = Eigen::Array<Scalar, strip_columns, 1>;

  /// Adds the products of a strip with some columns of another strip. Uses a parameter pack instead of loops over the
  /// columns: without unrolling, the sums would be in memory.
  template <std::size_t... Column>
  void add_tile(Eigen::Index rows, Eigen::Index strip, Eigen::Index column,
                std::index_sequence<Column...> /*columns*/) {
    const Scalar *left = block_.data() + strip * strip_size_, *right = &(*this)(0, column);
    std::array<piece, tile_columns> products{((void)Column, piece(piece::Zero()))...};
    for (Eigen::Index r = 0; r < rows; ++r, left += strip_columns, right += strip_columns) {
      const piece row = Eigen::Map<const piece, Eigen::AlignedMax>(left);
      ((products[Column] += row * right[Column]), ...);
    }
    const auto add_column = [&](const piece& product, double* to) {
      for (Eigen::Index i = 0; i < strip_columns; ++i) to[i] += double{product[i]};
    };
    (add_column(products[Column], &sum_(strip * strip_columns, column + Column)), ...);
  }

  Eigen::Index columns_, strips_, strip_size_;
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> block_;
  Eigen::MatrixXd sum_;
};

}  // namespace detail

}  // namespace gonio
