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

GONIO_INLINE three_columns::three_columns(const Eigen::MatrixXd& columns)
    : rows_(columns.rows()), sixteens_(48, (rows_ + 15) / 16) {
  sixteens_.setZero();
  const Eigen::Index last = std::max<Eigen::Index>(rows_ - 16, 0);
  for (Eigen::Index c = 0; c < 3; ++c)
    for (Eigen::Index i = 0; i < rows_; ++i)
      sixteens_(16 * c + i - std::min(i / 16 * 16, last), i / 16) = static_cast<float>(columns(i, c));
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
