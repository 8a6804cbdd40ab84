#pragma once
/// How a change of a material is seen, linearised at an estimate of it: CIELAB 1976 over the points of spheres. Unlike
/// `perceived_norm`, which is a mean over the materials of a prior, it is that of one material.

#include <gonio/core/parallel.hpp>
#include <gonio/design/sequential_design.hpp>
#include <gonio/metric/error_metric.hpp>
#include <gonio/table/location.hpp>
#include <gonio/table/valid_cells.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <span>

namespace gonio {

/// Two spheres over coarse cells, under the closed-form environment and under two lights (render/lighting.hpp), which
/// count the same. A value type: 24 bytes for each point and cell.
class perceived_sensitivity {
 public:
  /// Spheres of `size` x `size` points each.
  explicit perceived_sensitivity(valid_cells cells, int size = 14, thread_count threads = {});

  [[nodiscard]] const valid_cells& cells() const noexcept { return cells_; }

  /// By how much CIELAB colours change with the mapped values of each channel at the cells, given the estimate's
  /// reflectance there, sr^-1, and its derivative by the mapped value: cells x 3 each. Weights sum to 1, so that
  /// deviations are those of a mean Delta E. What is beyond white does not count. O(points x cells). Throws
  /// gonio::error for sizes that do not match.
  [[nodiscard]] design::sensitivity operator()(const Eigen::MatrixXd& reflectance,
                                               const Eigen::MatrixXd& derivative) const;

  /// The same at mapped values: cells x 3, at the cells' locations on a metric's.
  template <error_metric Metric>
  [[nodiscard]] design::sensitivity at(const Metric& metric, std::span<const location> locations,
                                       const Eigen::MatrixXd& mapped) const {
    constexpr double step = 0.05;
    Eigen::MatrixXd reflectance(mapped.rows(), 3), derivative(mapped.rows(), 3);
    for (Eigen::Index c = 0; c < 3; ++c)
      for (Eigen::Index i = 0; i < mapped.rows(); ++i) {
        const double below = metric.inverse(mapped(i, c) - step, locations[i]),
                     above = metric.inverse(mapped(i, c) + step, locations[i]);
        reflectance(i, c) = std::max((below + above) / 2.0, 0.0);
        derivative(i, c) = (above - below) / (2.0 * step);
      }
    return (*this)(reflectance, derivative);
  }

  /// Of the points; their sum is 1.
  [[nodiscard]] const Eigen::VectorXd& weights() const noexcept { return weights_; }

 private:
  valid_cells cells_;
  std::array<Eigen::MatrixXd, 3> light_;  ///< of each channel: points x cells
  Eigen::VectorXd weights_;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/evaluate/impl/perceived_sensitivity.ipp>
#endif
