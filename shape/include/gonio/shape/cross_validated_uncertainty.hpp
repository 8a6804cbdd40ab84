#pragma once
/// Measures the uncertainty of a recovered scan's vertices. Leaves shapes of the model out, scans them like the given
/// scan, recovers them from the others, and compares the results.

#include <gonio/core/parallel.hpp>
#include <gonio/shape/recovery.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace gonio::shape {

/// The settings of the measurement.
struct cross_validation_options {
  Eigen::Index trials = 40;   ///< number of shapes that are left out and recovered
  Eigen::Index parts = 5;     ///< number of parts of the shapes; one part is left out at a time
  recovery_options recovery;  ///< the options used for the scan
  std::uint64_t seed = 1;     ///< for the noise
};

/// The covariance of a recovered surface's vertices, in the model's space.
///
/// V{s1|s2} (see `shape_uncertainty`) assumes that known vertices are in the right place up to independent errors. On a
/// scan these errors are correlated. Vertices can slide along a surface with little change, and the model error of the
/// family, hundredths of a millimetre, is similar for neighbours and makes them slide by tenths. This class therefore
/// repeats the whole recovery, including the alignment by shape context, with shapes whose vertices are known: see
/// docs/decisions/0013-measured-uncertainty.md.
class cross_validated_uncertainty {
 public:
  /// Measures it for the result of `recover` for a scan and a model. Takes the time of that many recoveries. The result
  /// does not depend on the number of threads. Throws gonio::error for fewer than 10 trials or more than there are
  /// shapes, for fewer than two parts, if leaving one part out leaves fewer than two shapes, and if fewer than 10 of
  /// the shapes are recovered.
  cross_validated_uncertainty(const shape_model& model, const surface_index& scan, const recovered_shape& recovered,
                              const cross_validation_options& options = {}, thread_count threads = {});

  /// Returns the number of shapes that were recovered.
  [[nodiscard]] Eigen::Index trials() const noexcept { return trials_; }

  /// Returns the 3 x 3 covariance of one vertex about its recovered position.
  [[nodiscard]] const Eigen::Matrix3d& covariance(Eigen::Index vertex) const { return covariances_[vertex]; }

  /// Returns the squared radius such that a vertex is in the ellipsoid d' covariance^-1 d <= squared_radius(share) with
  /// this probability. It is the quantile of the left-out vertices under the covariance of the other trials, enlarged:
  /// the errors of one shape's vertices are correlated, and the scanned shape may be the worst of trials + 1 (Lee,
  /// Barber, Willett, "Distribution-free inference with hierarchical data", arXiv:2306.06342). Shares above trials /
  /// (trials + 1) cannot be determined and give the largest measured value. Throws gonio::error unless the share is
  /// above 0 and below 1.
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
