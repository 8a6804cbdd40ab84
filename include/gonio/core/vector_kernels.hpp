#pragma once
/// The inner loops of dense algebra on contiguous numbers, compiled once. As Eigen expressions they would be compiled
/// for each combination of matrices, columns and parts of columns.

#include <Eigen/Core>

#include <algorithm>
#include <array>

namespace gonio {

/// Return the sum of a[i] b[i].
[[nodiscard]] double dot(const double* a, const double* b, Eigen::Index count);
[[nodiscard]] float dot(const float* a, const float* b, Eigen::Index count);

/// Three columns of numbers for dot products with many rows. They are stored in blocks of sixteen. The last block is
/// aligned with the last sixteen numbers of a row, and is zero where it overlaps the block before. Products then need
/// no loop over remaining numbers.
class three_columns {
 public:
  explicit three_columns(const Eigen::MatrixXd& columns);

  /// Returns the dot products of a row with each column.
  [[nodiscard]] std::array<float, 3> dot_each(const float* row) const {
    sixteen sum_0 = sixteen::Zero(), sum_1 = sum_0, sum_2 = sum_0, short_row = sum_0;
    if (rows_ < 16) row = std::copy_n(row, rows_, short_row.data()) - rows_;
    const Eigen::Index last = std::max<Eigen::Index>(rows_ - 16, 0);
    for (Eigen::Index s = 0; s < sixteens_.cols(); ++s) {
      const sixteen these = Eigen::Map<const sixteen>(row + std::min(16 * s, last));
      sum_0 += these * sixteens_.block<16, 1>(0, s);
      sum_1 += these * sixteens_.block<16, 1>(16, s);
      sum_2 += these * sixteens_.block<16, 1>(32, s);
    }
    return {sum_0.sum(), sum_1.sum(), sum_2.sum()};
  }

 private:
  using sixteen = Eigen::Array<float, 16, 1>;
  Eigen::Index rows_;
  Eigen::Array<float, 48, Eigen::Dynamic> sixteens_;  // the columns' blocks, one below the other
};

/// Prefetches numbers that are read soon.
inline void prefetch(const float* numbers, Eigen::Index count) {
  constexpr Eigen::Index line = 64 / sizeof(float);
  for (Eigen::Index i = 0; i < count; i += line) __builtin_prefetch(numbers + i);
}

/// Returns the square root of the sum of a[i]^2, even if these squares overflow or underflow.
[[nodiscard]] double norm(const double* a, Eigen::Index count);

/// Returns the power of two that scales a positive length to [1/2, 1), or the nearest one that a double can hold; 1 for
/// zero.
[[nodiscard]] double near_inverse(double length);

/// Add factor * a[i] to sum[i].
void add_scaled(double factor, const double* a, double* sum, Eigen::Index count);
void add_scaled(float factor, const float* a, float* sum, Eigen::Index count);

/// Adds factor * a to sum, for matrices of equal size.
void add_scaled(double factor, const Eigen::MatrixXd& a, Eigen::MatrixXd& sum);

/// Multiplies product[i] by a[i].
void multiply(const float* a, float* product, Eigen::Index count);

/// Replaces each number by its exponential, accurate to 2 units in the last place. The result does not depend on the
/// number's position.
void exponentiate(float* numbers, Eigen::Index count);

/// Replace each number by its exponential, or by its natural logarithm.
void exponentiate(double* numbers, Eigen::Index count);
void take_logarithms(double* numbers, Eigen::Index count);

/// Calls `map` with sixteen numbers at a time, in an array whose numbers it replaces by the results. The last array is
/// padded with zeros. Without this, Eigen would round functions differently for numbers outside of whole vector
/// registers, depending on the memory address.
template <class Map>
void map_by_sixteens(float* numbers, Eigen::Index count, Map&& map) {
  using sixteen = Eigen::Array<float, 16, 1>;
  const Eigen::Index whole = count / 16 * 16;
  for (Eigen::Index i = 0; i < whole; i += 16) {
    sixteen these = Eigen::Map<const sixteen>(numbers + i);
    map(these);
    Eigen::Map<sixteen>{numbers + i} = these;
  }
  if (whole == count) return;
  sixteen rest = sixteen::Zero();
  std::copy_n(numbers + whole, count - whole, rest.data());
  map(rest);
  std::copy_n(rest.data(), count - whole, numbers + whole);
}

/// Returns a copy in single precision.
[[nodiscard]] Eigen::MatrixXf to_float(const Eigen::MatrixXd& numbers);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/core/impl/vector_kernels.ipp>
#endif
