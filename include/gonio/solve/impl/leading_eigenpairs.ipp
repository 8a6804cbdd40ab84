#pragma once
/// Bodies of solve/leading_eigenpairs.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/random.hpp>
#include <gonio/solve/householder_qr.hpp>
#include <gonio/solve/leading_eigenpairs.hpp>
#include <gonio/solve/product.hpp>
#include <gonio/solve/symmetric_eigen.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <utility>

namespace gonio::detail {

/// Returns random numbers of a normal distribution by Box and Muller's method. std::normal_distribution differs between
/// standard libraries, and a prior must have the same bytes with all of them.
[[nodiscard]] GONIO_INLINE Eigen::MatrixXd random_vectors(Eigen::Index rows, Eigen::Index columns, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  Eigen::MatrixXd vectors(rows, columns);
  for (Eigen::Index i = 0; i < vectors.size(); ++i) {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform_number(generator)));
    vectors.data()[i] = radius * std::cos(2.0 * std::numbers::pi * uniform_number(generator));
  }
  return vectors;
}

/// Returns -1 if the largest entry of a vector is negative, else 1.
template <class Vector>
[[nodiscard]] double sign_of_largest(const Vector& vector) {
  Eigen::Index largest = 0;
  vector.cwiseAbs().maxCoeff(&largest);
  return vector[largest] < 0.0 ? -1.0 : 1.0;
}

/// Returns orthonormal columns with the same span as `vectors`.
[[nodiscard]] GONIO_INLINE Eigen::MatrixXd orthonormalised(Eigen::MatrixXd vectors) {
  const Eigen::Index rows = vectors.rows(), columns = vectors.cols();
  const householder_qr factors(std::move(vectors));
  Eigen::MatrixXd q = Eigen::MatrixXd::Identity(rows, columns);
  for (Eigen::Index column = 0; column < columns; ++column) factors.apply(q.col(column).data());
  return q;
}

}  // namespace gonio::detail

namespace gonio {

GONIO_INLINE leading_eigenpairs decompose_leading(const Eigen::MatrixXd& matrix, Eigen::Index count, const char* what) {
  const symmetric_eigen eigen = decompose_symmetric(matrix, what);
  const Eigen::VectorXd descending = eigen.values.reverse();
  const double floor = descending[0] * static_cast<double>(matrix.rows()) * std::numeric_limits<double>::epsilon();
  const Eigen::Index kept = std::min<Eigen::Index>(count, (descending.array() > floor).count());
  leading_eigenpairs result{descending.head(kept), eigen.vectors.rowwise().reverse().leftCols(kept)};
  for (auto vector : result.vectors.colwise()) vector *= detail::sign_of_largest(vector);
  return result;
}

GONIO_INLINE subspace_eigenpairs iterate_leading(Eigen::Index size, Eigen::Index count, const subspace_options& options,
                                                 const matrix_times& times) {
  if (count < 1 || options.oversampling < 0 || options.products < 1)
    refuse({"leading eigenpairs need at least 1 eigenvalue, 1 product and 0 additional vectors, not ", count, ", ",
            options.products, " and ", options.oversampling});
  const Eigen::Index width = std::min(size, count + options.oversampling);
  // Multiply random vectors by the matrix several times (Alg. 4.4).
  Eigen::MatrixXd subspace = detail::orthonormalised(detail::random_vectors(size, width, options.seed));
  for (int product = 1; product < options.products; ++product)
    subspace = detail::orthonormalised(times(subspace, false));
  // Project the matrix onto the subspace, and compute the eigenpairs of the projection (Alg. 5.3).
  const Eigen::MatrixXd multiplied = times(subspace, true);
  Eigen::MatrixXd within = product(subspace.transpose(), multiplied);
  within = (0.5 * (within + within.transpose())).eval();
  const leading_eigenpairs inner = decompose_leading(within, count, "a Gram matrix within a subspace");

  subspace_eigenpairs found{{inner.values, product(subspace, inner.vectors)}, inner.vectors};
  for (Eigen::Index i = 0; i < found.combination.cols(); ++i) {
    const double sign = detail::sign_of_largest(found.pairs.vectors.col(i));
    found.pairs.vectors.col(i) *= sign;
    found.combination.col(i) *= sign;
  }
  const Eigen::MatrixXd residual =
      product(multiplied, found.combination) - found.pairs.vectors * found.pairs.values.asDiagonal();
  found.pairs.residual = residual.norm();
  return found;
}

}  // namespace gonio
