#pragma once
/// Bodies of estimate/left_out_error.hpp.

#include <gonio/basis/pca.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/estimate/left_out_error.hpp>
#include <gonio/estimate/mapped_noise.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <cmath>
#include <span>
#include <vector>

namespace gonio {

GONIO_INLINE Eigen::VectorXd left_out_error::operator()(const Eigen::VectorXd& etas) const {
  Eigen::VectorXd errors(etas.size());
  for_each_block(
      static_cast<std::size_t>(etas.size()), 1,
      [&](block range) {
        const auto e = static_cast<Eigen::Index>(range.begin);
        errors[e] = error_at(etas[e]);
      },
      threads_);
  return errors;
}

GONIO_INLINE left_out_error::sums& left_out_error::sums::operator+=(const sums& other) {
  gram += other.gram;
  noise += other.noise;
  shift += other.shift;
  return *this;
}

GONIO_INLINE void left_out_error::decompose(const Eigen::ArrayXd& energies, const sums& all) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(all.gram);
  if (eigen.info() != Eigen::Success) throw error("the eigenvalues of a least-squares problem do not converge");
  const Eigen::VectorXd& values = eigen.eigenvalues();
  const Eigen::Index rank = (values.array() > 1e-12 * values[values.size() - 1]).count();
  if (rank == 0 || !(values[values.size() - 1] > 0.0))
    throw error("eta cannot be chosen: the basis does not vary where was measured");
  values_ = values.tail(rank);
  vectors_ = eigen.eigenvectors().rightCols(rank);
  norm_ = vectors_.transpose() * energies.matrix().asDiagonal() * vectors_;
  noise_energy_ = norm_.cwiseProduct(vectors_.transpose() * all.noise * vectors_);
  shift_ = vectors_.transpose() * all.shift;
}

GONIO_INLINE void left_out_error::leave_out(const Eigen::ArrayXd& energies, const Eigen::MatrixXd& own,
                                            double observations) {
  const double others = observations - 3.0;
  const Eigen::VectorXd mean = own.colwise().sum().transpose() / -others;
  const Eigen::Matrix3d r = (Eigen::Matrix3d::Identity() + Eigen::Matrix3d::Constant(1.0 / others)).llt().matrixL();
  const Eigen::MatrixXd t = own.transpose().colwise() - mean, n = own.transpose() * r;
  const Eigen::MatrixXd mt = energies.matrix().asDiagonal() * t, mn = energies.matrix().asDiagonal() * n;
  const auto seen = vectors_.transpose();
  materials_.push_back({seen * t, seen * n, seen * mt, seen * mn, n.transpose() * mn, n.transpose() * mt,
                        t.cwiseProduct(mt).colwise().sum().transpose()});
}

GONIO_INLINE double left_out_error::error_at(double eta) const {
  const Eigen::VectorXd d = (values_.array() + eta).inverse();
  const double variance = d.dot(noise_energy_ * d);
  double sum = 0.0;
  for (const left_out& material : materials_)
    sum += (squared_bias(material, d) + variance).array().max(0.0).sqrt().sum();
  return sum / static_cast<double>(3 * materials_.size());
}

GONIO_INLINE Eigen::Array3d left_out_error::squared_bias(const left_out& material, const Eigen::VectorXd& d) const {
  const Eigen::VectorXd f = values_.cwiseProduct(d);
  const Eigen::MatrixXd fn = f.asDiagonal() * material.n;
  const Eigen::MatrixXd q = (values_.asDiagonal() * material.t).colwise() + shift_;
  const Eigen::MatrixXd dq = d.asDiagonal() * q;
  const Eigen::Matrix3d within = Eigen::Matrix3d::Identity() - material.n.transpose() * fn;
  const Eigen::MatrixXd u = dq + fn * within.fullPivLu().solve(material.n.transpose() * dq);
  // x - c = V u - N p, and its distance from t.
  const Eigen::Matrix3d p = material.n.transpose() * u;
  const auto dot = [](const auto& a, const auto& b) {
    return Eigen::Array3d(a.cwiseProduct(b).colwise().sum().transpose());
  };
  return material.energy.array() - 2.0 * (dot(u, material.mt) - dot(p, material.nmt)) + dot(u, norm_ * u) -
         2.0 * dot(u, material.mn * p) + dot(p, material.nmn * p);
}

}  // namespace gonio
