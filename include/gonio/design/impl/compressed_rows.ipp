#pragma once
/// Bodies of design/compressed_rows.hpp.

#include <gonio/basis/basis.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/design/compressed_rows.hpp>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE component_rows compressed(const component_rows& rows, double negligible) {
  const Eigen::MatrixXd& r = rows.components;
  const bool tall = r.rows() > r.cols();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(tall ? Eigen::MatrixXd(r.transpose() * r)
                                                                  : Eigen::MatrixXd(r * r.transpose()));
  const Eigen::VectorXd& values = eigen.eigenvalues();  // smallest first
  const auto dropped = std::ranges::count_if(values, [&](double value) { return !(value > negligible); });
  const Eigen::Index kept = values.size() - dropped;
  const auto vectors = eigen.eigenvectors().rightCols(kept);
  const Eigen::VectorXd roots = values.tail(kept).cwiseSqrt();
  if (tall)
    return {roots.asDiagonal() * vectors.transpose(),
            roots.cwiseInverse().asDiagonal() * (vectors.transpose() * (r.transpose() * rows.noise))};
  return {vectors.transpose() * r, vectors.transpose() * rows.noise};
}

}  // namespace gonio
