#pragma once
/// Factorisations of dense matrices as Eigen makes them, to compare with: compiled once for all tests.

#include <Eigen/Core>

#include <optional>

namespace dense_reference {

/// A = U diag(values) V', thin, values descending.
struct singular_value_decomposition {
  Eigen::MatrixXd u;
  Eigen::VectorXd values;
  Eigen::MatrixXd v;
};
[[nodiscard]] singular_value_decomposition svd(const Eigen::MatrixXd& a);

/// A = V diag(values) V' of a symmetric matrix, values ascending.
struct eigenvalue_decomposition {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
[[nodiscard]] eigenvalue_decomposition symmetric_eigen(const Eigen::MatrixXd& a);

/// Orthonormal columns that span those of A, which are not more than its rows.
[[nodiscard]] Eigen::MatrixXd orthonormal_columns(const Eigen::MatrixXd& a);

/// The least-squares solution of A x = b; nothing if a pivot is below `threshold` times the largest.
[[nodiscard]] std::optional<Eigen::VectorXd> least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                                           double threshold);

[[nodiscard]] Eigen::MatrixXd inverse(const Eigen::MatrixXd& a);
[[nodiscard]] double determinant(const Eigen::MatrixXd& a);

}  // namespace dense_reference
