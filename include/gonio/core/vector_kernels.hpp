#pragma once
/// The loops that dense algebra is made of, on contiguous numbers, compiled once: whoever writes them as
/// expressions pays for each combination of matrices, columns and parts of columns that occurs.

#include <Eigen/Core>

#include <algorithm>
#include <array>

namespace gonio {

/// The sum of a[i] b[i].
[[nodiscard]] double dot(const double* a, const double* b, Eigen::Index count);
[[nodiscard]] float dot(const float* a, const float* b, Eigen::Index count);

/// Three columns of numbers for dot products with many rows. They are kept by sixteens, of which the last starts where
/// a row's last sixteen numbers do and is zero where it overlaps the one before: no product needs a remainder.
class three_columns {
 public:
  explicit three_columns(const Eigen::MatrixXd& columns);

  /// The sums of row[i] times each column's i-th number.
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
  Eigen::Array<float, 48, Eigen::Dynamic> sixteens_;  // of each column one below the other
};

/// Asks for numbers that are read soon: they are at hand then.
inline void prefetch(const float* numbers, Eigen::Index count) {
  constexpr Eigen::Index line = 64 / sizeof(float);
  for (Eigen::Index i = 0; i < count; i += line) __builtin_prefetch(numbers + i);
}

/// The root of the sum of a[i]^2, also where these squares are out of range.
[[nodiscard]] double norm(const double* a, Eigen::Index count);

/// A power of two that brings a positive length to [1/2, 1), or as near as there is one; 1 for zero.
[[nodiscard]] double near_inverse(double length);

/// Adds factor a[i] to sum[i].
void add_scaled(double factor, const double* a, double* sum, Eigen::Index count);
void add_scaled(float factor, const float* a, float* sum, Eigen::Index count);

/// The same of matrices of one size.
void add_scaled(double factor, const Eigen::MatrixXd& a, Eigen::MatrixXd& sum);

/// Multiplies product[i] by a[i].
void multiply(const float* a, float* product, Eigen::Index count);

/// Replaces each number by its exponential, within 2 units of the last place, and the same wherever a number stands.
void exponentiate(float* numbers, Eigen::Index count);

/// Replaces each number by its exponential, or by its natural logarithm.
void exponentiate(double* numbers, Eigen::Index count);
void take_logarithms(double* numbers, Eigen::Index count);

/// Calls `map` for sixteen numbers at a time, an array that it replaces by their images; behind the last ones there are
/// zeros. Eigen rounds functions otherwise where a number stands alone before or after whole vector registers, which
/// depends on where the memory begins.
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

/// A copy in single precision.
[[nodiscard]] Eigen::MatrixXf to_float(const Eigen::MatrixXd& numbers);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/core/impl/vector_kernels.ipp>
#endif
