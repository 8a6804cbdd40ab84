#pragma once
/// Bodies of core/vector_kernels.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/vector_kernels.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>

namespace gonio {

GONIO_INLINE double dot(const double* a, const double* b, Eigen::Index count) {
  return Eigen::Map<const Eigen::VectorXd>(a, count).dot(Eigen::Map<const Eigen::VectorXd>(b, count));
}

GONIO_INLINE float dot(const float* a, const float* b, Eigen::Index count) {
  return Eigen::Map<const Eigen::VectorXf>(a, count).dot(Eigen::Map<const Eigen::VectorXf>(b, count));
}

GONIO_INLINE std::array<float, 3> dot_each(const float* a, const float* columns, Eigen::Index rows) {
  using eight = Eigen::Array<float, 8, 1>;
  using four = Eigen::Array4f;
  const float *b = columns, *c = b + rows, *d = c + rows;
  eight sum_b = eight::Zero(), sum_c = sum_b, sum_d = sum_b;
  Eigen::Index i = 0;
  for (; i + 8 <= rows; i += 8) {
    const eight these = Eigen::Map<const eight>(a + i);
    sum_b += these * Eigen::Map<const eight>(b + i);
    sum_c += these * Eigen::Map<const eight>(c + i);
    sum_d += these * Eigen::Map<const eight>(d + i);
  }
  const auto halves_of = [](const eight& sum) -> four {
    return Eigen::Map<const four>(sum.data()) + Eigen::Map<const four>(sum.data() + 4);
  };
  four half_b = halves_of(sum_b), half_c = halves_of(sum_c), half_d = halves_of(sum_d);
  if (i + 4 <= rows) {
    const four these = Eigen::Map<const four>(a + i);
    half_b += these * Eigen::Map<const four>(b + i);
    half_c += these * Eigen::Map<const four>(c + i);
    half_d += these * Eigen::Map<const four>(d + i);
    i += 4;
  }
  std::array<float, 3> sums{half_b.sum(), half_c.sum(), half_d.sum()};
  for (; i < rows; ++i) {
    sums[0] += a[i] * b[i];
    sums[1] += a[i] * c[i];
    sums[2] += a[i] * d[i];
  }
  return sums;
}

GONIO_INLINE double near_inverse(double length) {
  return length > 0.0 ? std::ldexp(1.0, std::min(-(std::ilogb(length) + 1), 1023)) : 1.0;
}

GONIO_INLINE double norm(const double* a, Eigen::Index count) {
  double largest = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) largest = std::max(largest, std::abs(a[i]));
  if (largest == 0.0) return 0.0;
  const double inverse = near_inverse(largest);
  double sum = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) sum += (inverse * a[i]) * (inverse * a[i]);
  return std::sqrt(sum) / inverse;
}

GONIO_INLINE void add_scaled(double factor, const double* a, double* sum, Eigen::Index count) {
  Eigen::Map<Eigen::VectorXd>(sum, count) += factor * Eigen::Map<const Eigen::VectorXd>(a, count);
}

GONIO_INLINE void add_scaled(float factor, const float* a, float* sum, Eigen::Index count) {
  Eigen::Map<Eigen::VectorXf>(sum, count) += factor * Eigen::Map<const Eigen::VectorXf>(a, count);
}

GONIO_INLINE void add_scaled(double factor, const Eigen::MatrixXd& a, Eigen::MatrixXd& sum) {
  add_scaled(factor, a.data(), sum.data(), sum.size());
}

GONIO_INLINE void multiply(const float* a, float* product, Eigen::Index count) {
  Eigen::Map<Eigen::ArrayXf>(product, count) *= Eigen::Map<const Eigen::ArrayXf>(a, count);
}

GONIO_INLINE void exponentiate(float* numbers, Eigen::Index count) {
  map_by_sixteens(numbers, count, [](auto& these) { these = these.exp(); });
}

GONIO_INLINE void exponentiate(double* numbers, Eigen::Index count) {
  Eigen::Map<Eigen::ArrayXd> these(numbers, count);
  these = these.exp();
}

GONIO_INLINE void take_logarithms(double* numbers, Eigen::Index count) {
  Eigen::Map<Eigen::ArrayXd> these(numbers, count);
  these = these.log();
}

GONIO_INLINE Eigen::MatrixXf to_float(const Eigen::MatrixXd& numbers) {
  Eigen::MatrixXf copy(numbers.rows(), numbers.cols());
  for (Eigen::Index i = 0; i < copy.size(); ++i) copy.data()[i] = static_cast<float>(numbers.data()[i]);
  return copy;
}

}  // namespace gonio
