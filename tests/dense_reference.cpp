#include "dense_reference.hpp"

#include <Eigen/Dense>

namespace dense_reference {

singular_value_decomposition svd(const Eigen::MatrixXd& a) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> found(a, Eigen::ComputeThinU | Eigen::ComputeThinV);
  return {found.matrixU(), found.singularValues(), found.matrixV()};
}

eigenvalue_decomposition symmetric_eigen(const Eigen::MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> found(a);
  return {found.eigenvalues(), found.eigenvectors()};
}

Eigen::MatrixXd orthonormal_columns(const Eigen::MatrixXd& a) {
  return Eigen::HouseholderQR<Eigen::MatrixXd>(a).householderQ() * Eigen::MatrixXd::Identity(a.rows(), a.cols());
}

std::optional<Eigen::VectorXd> least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, double threshold) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factor(a);
  factor.setThreshold(threshold);
  if (factor.rank() < a.cols()) return {};
  return factor.solve(b);
}

Eigen::MatrixXd inverse(const Eigen::MatrixXd& a) { return a.inverse(); }
double determinant(const Eigen::MatrixXd& a) { return a.determinant(); }

}  // namespace dense_reference
