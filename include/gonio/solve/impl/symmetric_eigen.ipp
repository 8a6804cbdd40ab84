#pragma once
/// Bodies of solve/symmetric_eigen.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/solve/symmetric_eigen.hpp>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <string>

namespace gonio {

namespace detail {

/// The tridiagonal form A = scale Q T Q'. The scale, the largest entry of A, keeps squares of entries within range.
struct tridiagonal_form {
  explicit tridiagonal_form(const matrix_view& a) : scale(largest(a)), form(a / scale) {}

  [[nodiscard]] static double largest(const matrix_view& a) {
    double found = 0.0;
    for (Eigen::Index j = 0; j < a.cols(); ++j)
      for (Eigen::Index i = j; i < a.rows(); ++i) found = std::max(found, std::abs(a(i, j)));
    return found > 0.0 ? found : 1.0;
  }

  double scale;
  Eigen::Tridiagonalization<Eigen::MatrixXd> form;
};

/// Decomposes T, given its diagonal and subdiagonal.
[[nodiscard]] GONIO_INLINE Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen_solver(const Eigen::VectorXd& diagonal,
                                                                                       const Eigen::VectorXd& beside,
                                                                                       int options, const char* what) {
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal, beside, options);
  if (solver.info() != Eigen::Success) refuse(std::string("the eigenvalues of ") + what + " do not converge");
  return solver;
}

/// Replaces z by Q z: applies the reflections I - tau (1, v)(1, v)' one after the other to each column. Eigen's product
/// with Q, as used in SelfAdjointEigenSolver::compute, would double the compile time of this file.
GONIO_INLINE void multiply_by_q(const Eigen::Tridiagonalization<Eigen::MatrixXd>& form, Eigen::MatrixXd& z) {
  const Eigen::Index n = z.rows();
  const Eigen::MatrixXd packed = form.packedMatrix();
  const Eigen::VectorXd tau = form.householderCoefficients();
  for (Eigen::Index j = 0; j < z.cols(); ++j)
    for (Eigen::Index i = n - 2; i >= 0; --i) {
      const double* v = packed.data() + i * n + i + 2;
      double* of = z.data() + j * n + i + 1;
      const double along = tau[i] * (of[0] + dot(v, of + 1, n - i - 2));
      of[0] -= along;
      add_scaled(-along, v, of + 1, n - i - 2);
    }
}

}  // namespace detail

GONIO_INLINE symmetric_eigen decompose_symmetric(const matrix_view& a, const char* what) {
  const detail::tridiagonal_form of(a);
  const auto solver = detail::eigen_solver(of.form.diagonal(), of.form.subDiagonal(), Eigen::ComputeEigenvectors, what);
  symmetric_eigen found{of.scale * solver.eigenvalues(), solver.eigenvectors()};
  detail::multiply_by_q(of.form, found.vectors);
  return found;
}

GONIO_INLINE Eigen::VectorXd symmetric_eigenvalues(const matrix_view& a, const char* what) {
  const detail::tridiagonal_form of(a);
  return of.scale *
         detail::eigen_solver(of.form.diagonal(), of.form.subDiagonal(), Eigen::EigenvaluesOnly, what).eigenvalues();
}

GONIO_INLINE Eigen::VectorXd tridiagonal_eigenvalues(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& beside,
                                                     const char* what) {
  return detail::eigen_solver(diagonal, beside, Eigen::EigenvaluesOnly, what).eigenvalues();
}

}  // namespace gonio
