#pragma once
/// How sure the vertices of a recovered scan are, measured: shapes of the model are left out, shown as the scan shows
/// its own, recovered from the others, and compared.

#include <gonio/core/parallel.hpp>
#include <gonio/shape/recovery.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace gonio::shape {

/// How an uncertainty is measured.
struct cross_validation_options {
  Eigen::Index trials = 40;   ///< shapes that are left out and recovered
  Eigen::Index parts = 5;     ///< of the shapes; one of them is left out at a time
  recovery_options recovery;  ///< by which the scan was recovered
  std::uint64_t seed = 1;     ///< of the noise
};

/// The covariance of a recovered surface's vertices, in the model's space.
///
/// V{s1|s2} (see `shape_uncertainty`) takes known vertices to be where they belong, but for errors that are
/// independent. On a scan they are not: a surface looks nearly the same when vertices slide along it, and what the
/// family cannot say, hundredths of a millimetre, is off alike for neighbours and makes them slide by tenths. So this
/// repeats the whole recovery, from the alignment by shape context on, with shapes whose vertices are known: see
/// docs/decisions/0013-measured-uncertainty.md.
class cross_validated_uncertainty {
 public:
  /// Of what `recover` made of a scan by a model. As long as so many recoveries; the same for any number of threads.
  /// Throws gonio::error for fewer than 10 trials or more than there are shapes, for fewer than two parts or parts of
  /// which one leaves fewer than two shapes, and if fewer than 10 of the shapes are recovered.
  cross_validated_uncertainty(const shape_model& model, const surface_index& scan, const recovered_shape& recovered,
                              const cross_validation_options& options = {}, thread_count threads = {});

  /// How many shapes were recovered.
  [[nodiscard]] Eigen::Index trials() const noexcept { return trials_; }

  /// 3 x 3, of the position of one vertex about where it was recovered.
  [[nodiscard]] const Eigen::Matrix3d& covariance(Eigen::Index vertex) const { return covariances_[vertex]; }

  /// A vertex is within the ellipsoid d' covariance^-1 d <= squared_radius(share) with this probability. So many of the
  /// vertices that were left out are, by the covariance of the other trials, and some more: the vertices of one shape
  /// are off together, and of trials + 1 shapes the one that was scanned may be the farthest off (Lee, Barber, Willett,
  /// "Distribution-free inference with hierarchical data", arXiv:2306.06342). Shares above trials / (trials + 1) cannot
  /// be told; for them it is the largest that was measured. Throws gonio::error unless the share is above 0 and
  /// below 1.
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
