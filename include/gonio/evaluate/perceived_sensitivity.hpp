#pragma once
/// The visible effect of changing a material, linearised at its estimate: CIELAB 1976 over the points of spheres. It is
/// specific to one material; `perceived_norm` is a mean over the materials of a prior.

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

/// Two spheres over coarse cells, under the closed-form environment and under two lights (render/lighting.hpp), with
/// equal weight. A value type: 24 bytes for each point and cell.
class perceived_sensitivity {
 public:
  /// Each sphere is `size` points across.
  explicit perceived_sensitivity(valid_cells cells, int size = 14, thread_count threads = {});

  [[nodiscard]] const valid_cells& cells() const noexcept { return cells_; }

  /// Returns by how much the CIELAB colour of each point changes, as a distance, for each unit of a channel's mapped
  /// value at a cell. Takes the estimate's reflectance at the cells in sr^-1 and the derivative of reflectance by the
  /// mapped value: cells x 3 each. The weights of the points sum to 1, so `seen_deviation` is a mean Delta E. Light
  /// above white is ignored. O(points x cells). Throws gonio::error for sizes that do not match.
  [[nodiscard]] design::sensitivity operator()(const Eigen::MatrixXd& reflectance,
                                               const Eigen::MatrixXd& derivative) const;

  /// Returns the sensitivity of an estimate given as mapped values, cells x 3. `locations` are the locations of this
  /// sphere's cells on the metric's cells.
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

  /// Returns the weights of the points; their sum is 1.
  [[nodiscard]] const Eigen::VectorXd& weights() const noexcept { return weights_; }

 private:
  valid_cells cells_;
  std::array<Eigen::MatrixXd, 3> light_;  ///< per channel: points x cells
  Eigen::VectorXd weights_;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/evaluate/impl/perceived_sensitivity.ipp>
#endif
