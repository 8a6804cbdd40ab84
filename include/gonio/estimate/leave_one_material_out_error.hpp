#pragma once
/// The expected error of reconstructing a material that is not in the basis, for given locations and noise. It is the
/// expected error of Xu et al. 2016 (doi:10.1145/2980179.2982396), Eq. 12-15 (`expected_error`), except that each
/// material is left out of the basis before it is reconstructed. As a function of Tikhonov's penalty, this error has a
/// minimum. If materials were not left out, the best penalty would be zero.

#include <gonio/basis/pca.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/estimate/mapped_noise.hpp>

#include <Eigen/Core>

#include <span>
#include <utility>
#include <vector>

namespace gonio {

/// The norm of the reconstruction error over the cells that the basis was learned on, sqrt(bias^2 + variance), averaged
/// over all observations (colours or wavelengths of materials).
///
/// Leaving a material out needs no new components. The m observations have coefficients C, m x k, with orthonormal
/// columns that sum to zero. Without the p rows C_j of a material, the remaining rows have the mean c = -C_j'1 / (m -
/// p) and the sum of squares S = C'C - C_j'C_j - (m - p) c c' = I - N N' with N = C_j'R, R R' = I + 1 1' / (m - p). The
/// reconstruction by the remaining materials' components equals the reconstruction by all components, with S instead of
/// I as the prior covariance of the weights:
///
///   x = c + S A'(A S A' + eta I)^-1 (y - A c), A the rows of the basis at the locations, y the mapped measurement.
///
/// With A'A = V diag(l) V', D = diag(1 / (l + eta)), F = diag(l) D, q = V'A'(y - A c) and n = V'N, Woodbury's identity
/// gives x = c + S V (D q + F n (I - n'F n)^-1 n'D q).
///
/// If k is less than the number of all components, the variance of the missing components counts as measurement noise;
/// this variance is taken as the same fraction of the variance at every location. The effect of noise is computed with
/// the basis of all materials.
class leave_one_material_out_error {
 public:
  /// Takes n locations, a weight for each as in a least-squares problem, and the standard deviation of the noise
  /// relative to the values. O(n k^2 + k^3 + observations k^2). Throws gonio::error for noise that is negative or not
  /// finite, for a number of weights other than n, and for a basis of fewer than two materials.
  template <error_metric Metric>
  leave_one_material_out_error(const pca<Metric>& basis, std::span<const location> locations,
                               const Eigen::VectorXd& weights, double noise, thread_count threads = {})
      : threads_(threads) {
    require_sensible(locations.size(), weights, basis.names().size());
    const mapped_noise mapped = map_noise(basis, locations, noise, threads);
    initialise(add_rows(basis, locations, weights, mapped, threads), basis.singular_values(), basis.coefficients(),
               basis.channels());
  }

  /// Returns the largest eigenvalue of A'WA, where A has the rows of the basis at the locations and W their weights.
  [[nodiscard]] double largest() const { return values_[values_.size() - 1]; }

  /// Returns the error at each eta, which must be positive. O(observations r^2) each, where r <= min(n, k) is the rank
  /// of the rows.
  [[nodiscard]] Eigen::VectorXd operator()(const Eigen::VectorXd& etas) const;

 private:
  /// Sums over the locations: A'WA (`gram`), and the covariance (`noise`) and the mean (`shift`) of the noise in A'W y.
  struct sums {
    Eigen::MatrixXd gram, noise;
    Eigen::VectorXd shift;

    explicit sums(Eigen::Index k);
    sums& operator+=(const sums& other);
    /// Adds locations. Column i has the row of the basis at location i.
    void add(Eigen::MatrixXd columns, const Eigen::VectorXd& weights, const Eigen::VectorXd& shifts,
             const Eigen::VectorXd& variances);
  };

  /// A material in the coordinates of the eigenvectors V: t is the difference of its weights from the mean of all other
  /// materials, N is the matrix in the class comment, and M is the diagonal matrix of the squared singular values.
  struct excluded_material {
    Eigen::MatrixXd t, n, mt, mn;  // V't, V'N, V'M t, V'M N: r x channels
    Eigen::MatrixXd nmn, nmt;      // N'M N, N'M t
    Eigen::VectorXd tmt;           // t'M t of each channel
  };

  template <error_metric Metric>
  [[nodiscard]] static sums add_rows(const pca<Metric>& basis, std::span<const location> locations,
                                     const Eigen::VectorXd& weights, const mapped_noise& mapped, thread_count threads) {
    const Eigen::Index k = basis.size();
    const double observations = basis.observations();
    const double missing = (1.0 / basis.explained_variance() - 1.0) / observations;
    return sum_over_blocks(
        locations.size(), 256, sums(k),
        [&](sums& sum, block range) {
          const Eigen::Index begin = range.begin, count = range.size();
          Eigen::MatrixXd columns(k, count);
          Eigen::VectorXd variances = mapped.variance.segment(begin, count);
          for (Eigen::Index i = 0; i < count; ++i) {
            const location& here = locations[range.begin + i];
            read_row_at(basis, here, Eigen::Map<Eigen::RowVectorXd>(columns.col(i).data(), k));
            variances[i] += missing * columns.col(i).squaredNorm();
          }
          sum.add(std::move(columns), weights.segment(begin, count), mapped.shift.segment(begin, count), variances);
        },
        threads);
  }

  /// Throws gonio::error unless there is a weight for each location, at least one location, and at least two materials.
  static void require_sensible(Eigen::Index locations, const Eigen::VectorXd& weights, Eigen::Index materials);

  void initialise(const sums& all, const Eigen::VectorXd& singular_values, const Eigen::MatrixXf& coefficients,
                  Eigen::Index channels);

  /// Computes the eigenvectors V and eigenvalues l of `gram` without those that are rounding errors, and everything
  /// else that does not depend on the material. `squares` is the diagonal of M.
  void decompose(const Eigen::VectorXd& squares, const sums& all);

  /// Returns the state of a left-out material. `own` has the material's rows of C as columns.
  [[nodiscard]] excluded_material leave_out(const Eigen::VectorXd& squares, const Eigen::MatrixXd& own,
                                            double observations) const;

  [[nodiscard]] double error_at(double eta) const;

  [[nodiscard]] Eigen::VectorXd squared_bias(const excluded_material& material, const Eigen::VectorXd& d) const;

  Eigen::VectorXd values_;      // l, ascending
  Eigen::MatrixXd vectors_;     // V
  Eigen::MatrixXd norm_;        // V'M V
  Eigen::MatrixXd noise_norm_;  // element-wise product of V'M V and the noise in V'A'W y
  Eigen::VectorXd shift_;       // mean of the noise in V'A'W y
  std::vector<excluded_material> materials_;
  thread_count threads_;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/leave_one_material_out_error.ipp>
#endif
