#pragma once
/// A norm of the errors of a basis' weights that measures how visible they are. `expected_error` takes it for
/// perceptual designs.

#include <gonio/basis/pca.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/render/sphere.hpp>
#include <gonio/solve/cholesky.hpp>
#include <gonio/solve/float_product.hpp>

#include <Eigen/Core>

#include <cmath>
#include <span>
#include <vector>

namespace gonio {

namespace detail {

/// Returns d L* / d Y of a grey of luminance Y on a display with white 1; 0 above white.
[[nodiscard]] double lightness_slope(double luminance) noexcept;

/// Returns the derivative of one point's lightness by the k weights, for each of a basis' m observations: m x k.
template <error_metric Metric>
[[nodiscard]] Eigen::MatrixXf lightness_jacobian(const pca<Metric>& basis, const render::sphere_operator& sphere,
                                                 Eigen::Index point) {
  std::vector<Eigen::Index> cells;
  std::vector<double> weights;
  sphere.for_each_entry(point, [&](Eigen::Index cell, const rgb& weight) {
    cells.push_back(cell);
    weights.push_back(luminance(weight));
  });
  const auto entries = std::ssize(cells);
  Eigen::MatrixXf components(basis.size(), entries);
  for (Eigen::Index e = 0; e < entries; ++e) components.col(e) = basis.components().row(cells[e]);

  // Sum each observation's reflected light, and compute its derivative by each mapped value.
  constexpr double step = 0.05;
  Eigen::MatrixXf mapped = product(basis.coefficients(), components);
  Eigen::VectorXd luminances = Eigen::VectorXd::Zero(mapped.rows());
  for (Eigen::Index e = 0; e < entries; ++e) {
    const Eigen::Index cell = cells[e];
    const double weight = weights[e], offset = basis.offset(cell);
    for (Eigen::Index i = 0; i < mapped.rows(); ++i) {
      const double y = offset + double{mapped(i, e)};
      const double lower = basis.metric().inverse(y - step, cell), upper = basis.metric().inverse(y + step, cell);
      luminances[i] += weight * std::max((lower + upper) / 2.0, 0.0);
      mapped(i, e) = static_cast<float>(weight * (upper - lower) / (2.0 * step));
    }
  }
  Eigen::MatrixXf jacobian = product(mapped, components.transpose());
  for (Eigen::Index i = 0; i < jacobian.rows(); ++i)
    jacobian.row(i) *= static_cast<float>(lightness_slope(luminances[i]));
  return jacobian;
}

}  // namespace detail

/// Returns M, k x k: x'Mx is the mean squared change of a sphere's CIELAB lightness when the k weights of an
/// observation change by a small x. The mean is over the points of the sphere and the observations that the basis was
/// learned from.
///
/// Use it in `expected_error(basis, options, M)`. Cells count by their contribution to the visible image, errors may
/// cancel in the light of a point, and light above white is ignored. Each colour channel is treated as grey. Costs 4 k
/// m operations for each entry of the sphere and 2 k^2 m for each point, for m observations. The bytes do not depend on
/// the number of threads. Throws gonio::error if the sphere is over other cells.
template <error_metric Metric>
[[nodiscard]] Eigen::MatrixXd perceived_norm(const pca<Metric>& basis, const render::sphere_operator& sphere,
                                             thread_count threads = {}) {
  if (!(basis.cells() == sphere.cells())) refuse("a basis and a sphere must be over the same cells");
  constexpr Eigen::Index points_of_a_sum = 8;
  const Eigen::Index points = sphere.points().size();
  const Eigen::Index k = basis.size();
  std::vector<Eigen::MatrixXd> sums((points + points_of_a_sum - 1) / points_of_a_sum, Eigen::MatrixXd::Zero(k, k));
  for_each_block(
      sums.size(), 1,
      [&](block range) {
        const Eigen::Index end = std::min(range.end * points_of_a_sum, points);
        for (Eigen::Index point = range.begin * points_of_a_sum; point < end; ++point) {
          const Eigen::MatrixXf jacobian = detail::lightness_jacobian(basis, sphere, point);
          sums[point / points_of_a_sum] += product_with_transpose(jacobian.transpose().cast<double>());
        }
      },
      threads);
  Eigen::MatrixXd norm = Eigen::MatrixXd::Zero(k, k);
  for (const Eigen::MatrixXd& sum : sums) norm += sum;
  return norm / (static_cast<double>(points) * basis.observations());
}

/// Returns the mean of M for two spheres: under two directional lights, and under the closed-form environment
/// (render/lighting.hpp). The spheres are coarse enough to take only seconds.
template <error_metric Metric>
[[nodiscard]] Eigen::MatrixXd perceived_norm(const pca<Metric>& basis, thread_count threads = {}) {
  constexpr int size = 20;
  const render::sphere_operator lights(basis.cells(), render::two_lights(), size, threads),
      environment(basis.cells(), render::environment_lighting(45, 24), size, threads);
  return (perceived_norm(basis, lights, threads) + perceived_norm(basis, environment, threads)) / 2.0;
}

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/evaluate/impl/perceived_norm.ipp>
#endif
