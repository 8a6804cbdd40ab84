#pragma once
/// Bodies of solve/symmetric_eigen.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/solve/symmetric_eigen.hpp>

#include <Eigen/Eigenvalues>

#include <string>

namespace gonio {

namespace detail {

[[nodiscard]] GONIO_INLINE Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen_solver(const matrix_view& a,
                                                                                       int options, const char* what) {
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a.rows());
  solver.compute(a, options);
  if (solver.info() != Eigen::Success) refuse(std::string("the eigenvalues of ") + what + " do not converge");
  return solver;
}

}  // namespace detail

GONIO_INLINE symmetric_eigen decompose_symmetric(const matrix_view& a, const char* what) {
  const auto solver = detail::eigen_solver(a, Eigen::ComputeEigenvectors, what);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

GONIO_INLINE Eigen::VectorXd symmetric_eigenvalues(const matrix_view& a, const char* what) {
  return detail::eigen_solver(a, Eigen::EigenvaluesOnly, what).eigenvalues();
}

}  // namespace gonio
