#pragma once
/// How a change of a material is seen, linearised at an estimate of it: CIELAB 1976 over the points of spheres. Unlike
/// `perceived_norm`, which is a mean over the materials of a prior, it is that of one material.

#include <gonio/core/parallel.hpp>
#include <gonio/design/sequential_design.hpp>
#include <gonio/table/valid_cells.hpp>

#include <Eigen/Core>

#include <array>

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

 private:
  valid_cells cells_;
  std::array<Eigen::MatrixXd, 3> light_;  ///< of each channel: points x cells
  Eigen::VectorXd weights_;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/evaluate/impl/perceived_sensitivity.ipp>
#endif
