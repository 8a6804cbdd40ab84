#pragma once
/// Measures the uncertainty of a recovered scan's vertices: leaves shapes out of the model, scans them like the given
/// scan, recovers them with the remaining model, and compares the results with the known vertices.

#include <gonio/core/parallel.hpp>
#include <gonio/shape/recovery.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace gonio::shape {

/// The settings of the measurement.
struct cross_validation_options {
  Eigen::Index trials = 40;   ///< number of shapes to leave out and recover
  Eigen::Index parts = 5;     ///< number of parts that the shapes are divided into; each trial's model lacks one part
  recovery_options recovery;  ///< the options used for the scan
  std::uint64_t seed = 1;     ///< seed of the simulated noise
};

/// The covariance of a recovered surface's vertices, in the model's space.
///
/// V{s1|s2} (see `shape_uncertainty`) assumes that known positions have independent errors. On a scan the errors are
/// correlated: the model error, about 0.01 mm, is similar for neighbours, and the fit compensates by sliding vertices
/// about 0.1 mm along the surface. This class therefore repeats the whole recovery, including the alignment by shape
/// context, with shapes whose vertices are known: see docs/decisions/0013-measured-uncertainty.md.
class cross_validated_uncertainty {
 public:
  /// Measures the covariance for `recovered`, the result of `recover` for this model and scan. Takes the time of
  /// `trials` recoveries. The result does not depend on the number of threads. Throws gonio::error for fewer than 10
  /// trials or more trials than shapes, for fewer than two parts, if leaving out a part leaves fewer than two shapes,
  /// and if fewer than 10 trials recover their shape.
  cross_validated_uncertainty(const shape_model& model, const surface_index& scan, const recovered_shape& recovered,
                              const cross_validation_options& options = {}, thread_count threads = {});

  /// Returns the number of shapes that were recovered.
  [[nodiscard]] Eigen::Index trials() const noexcept { return trials_; }

  /// Returns the 3 x 3 covariance of one vertex about its recovered position.
  [[nodiscard]] const Eigen::Matrix3d& covariance(Eigen::Index vertex) const { return covariances_[vertex]; }

  /// Returns the squared radius of the ellipsoid d' covariance^-1 d <= squared_radius(share) that contains a vertex
  /// with probability `share`; d is the vertex's offset from its recovered position. The squared radius is the quantile
  /// `share` (1 + 1 / n) of the vertex errors in n trials, each under the covariance of the other trials. (The errors
  /// of one shape's vertices are correlated, and the scanned shape may be the worst of n + 1: Lee, Barber, Willett,
  /// "Distribution-free inference with hierarchical data", arXiv:2306.06342.) If the share is above n / (n + 1), the
  /// result is the largest measured value. Throws gonio::error unless the share is above 0 and below 1.
  [[nodiscard]] double squared_radius(double share) const;

 private:
  void add_vertex(const std::vector<point_columns>& errors, Eigen::Index vertex);

  Eigen::Index trials_ = 0;
  std::vector<Eigen::Matrix3d> covariances_;
  std::vector<double> squared_distances_;  // ascending
};

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/cross_validated_uncertainty.ipp>
#endif
