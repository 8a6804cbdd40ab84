#pragma once
/// What a reconstruction from given places and noise is expected to miss of a material that the basis has not seen: the
/// expected error of Xu et al. 2016, Eq. 12-15 (`expected_error`), but each material is left out of the basis before it
/// is reconstructed. That makes it a function of Tikhonov's penalty worth minimising: a material that the basis
/// contains is reconstructed best without any.

#include <gonio/basis/pca.hpp>
#include <gonio/estimate/mapped_noise.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <cmath>
#include <span>
#include <vector>

namespace gonio {

/// The mean over all observations (colour channels of materials) that a basis was learned from of the norm, over the
/// cells that it was learned on, of what the reconstruction misses; sqrt(bias^2 + variance) of each.
///
/// Leaving a material out needs no new components. The m observations have coefficients C, m x k, with orthonormal
/// columns that sum to zero; without three of them, C_3, the others have the mean c = -C_3'1 / (m - 3) and the sum of
/// squares S = C'C - C_3'C_3 - (m - 3) c c' = I - N N' with N = C_3'R, R R' = I + 1 1' / (m - 3). The reconstruction by
/// the others' components is that by all, with S for the weights' prior covariance instead of I:
///
///   x = c + S A'(A S A' + eta I)^-1 (y - A c), A the rows of the basis at the places, y the mapped measurement.
///
/// With A'A = V diag(l) V', D = diag(1 / (l + eta)) and F = diag(l) D that is, by Woodbury's identity,
/// x = c + S V (D q + F n (I - n'F n)^-1 n'D q), q = V'A'(y - A c), n = V'N.
///
/// Where k is less than all components, what the materials have beyond them is noise of the measurements, taken for the
/// same share of the variance everywhere. What noise adds is taken from the basis of all materials.
class left_out_error {
 public:
  /// n places with a weight each, as a least-squares problem has them, and the relative deviation of what is measured
  /// there. O(n k^2 + k^3 + materials k^2). Throws gonio::error for noise that is negative or not finite, as many
  /// weights as there are not places, and a basis of fewer than two materials.
  template <error_metric Metric>
  left_out_error(const pca<Metric>& basis, std::span<const location> places, const Eigen::VectorXd& weights,
                 double noise, thread_count threads = {})
      : threads_(threads) {
    if (weights.size() != std::ssize(places) || places.empty())
      throw error(std::to_string(places.size()) + " places need as many weights, not " +
                  std::to_string(weights.size()) + ", and at least one");
    if (basis.names().size() < 2)
      throw error("one material alone cannot be left out of what was learned from it: eta must be stated");
    const mapped_noise mapped = map_noise(basis, places, noise, threads);
    const sums all = add_rows(basis, places, weights, mapped, threads);
    decompose(basis.singular_values().array().square(), all);
    for (std::size_t material = 0; material < basis.names().size(); ++material)
      leave_out(basis.singular_values().array().square(),
                basis.coefficients().middleRows(static_cast<Eigen::Index>(3 * material), 3).template cast<double>(),
                static_cast<double>(basis.coefficients().rows()));
  }

  /// The largest eigenvalue of A'WA.
  [[nodiscard]] double largest() const { return values_.maxCoeff(); }

  /// The error at each eta, which must be positive. O(materials r^2) each, where r <= min(n, k) is the rows' rank.
  [[nodiscard]] Eigen::VectorXd operator()(const Eigen::VectorXd& etas) const;

 private:
  /// A'WA, what noise is in A'W y (its covariance), and what it shifts that by.
  struct sums {
    Eigen::MatrixXd gram, noise;
    Eigen::VectorXd shift;
    sums& operator+=(const sums& other);
  };

  /// A material in the eigenvectors V: t is what it differs by from the others' mean, n as above, M = Sigma^2.
  struct left_out {
    Eigen::MatrixXd t, n, mt, mn;  // V't, V'N, V'M t, V'M N: r x 3
    Eigen::Matrix3d nmn, nmt;      // N'M N, N'M t
    Eigen::Vector3d energy;        // t'M t of each channel
  };

  template <error_metric Metric>
  [[nodiscard]] static sums add_rows(const pca<Metric>& basis, std::span<const location> places,
                                     const Eigen::VectorXd& weights, const mapped_noise& mapped, thread_count threads) {
    const auto k = static_cast<Eigen::Index>(basis.size());
    const auto observations = static_cast<double>(basis.coefficients().rows());
    const double beyond = (1.0 / basis.explained_variance() - 1.0) / observations;
    const sums zero{Eigen::MatrixXd::Zero(k, k), Eigen::MatrixXd::Zero(k, k), Eigen::VectorXd::Zero(k)};
    return sum_over_blocks(
        places.size(), 256, zero,
        [&](sums& sum, block range) {
          const auto begin = static_cast<Eigen::Index>(range.begin), count = static_cast<Eigen::Index>(range.size());
          Eigen::MatrixXd rows(count, k);
          for (Eigen::Index i = 0; i < count; ++i)
            read_row_at(basis, places[range.begin + static_cast<std::size_t>(i)], rows.row(i));
          const auto weight = weights.segment(begin, count).array();
          const Eigen::ArrayXd variance =
              mapped.variance.segment(begin, count).array() + beyond * rows.rowwise().squaredNorm().array();
          const Eigen::MatrixXd weighted = weight.matrix().asDiagonal() * rows;
          sum.gram.noalias() += weighted.transpose() * rows;
          sum.noise.noalias() += weighted.transpose() * variance.matrix().asDiagonal() * weighted;
          sum.shift.noalias() += weighted.transpose() * mapped.shift.segment(begin, count);
        },
        threads);
  }

  /// V and l, without what is rounding, and all that does not depend on the material.
  void decompose(const Eigen::ArrayXd& energies, const sums& all);

  /// `own`: the material's three rows of C.
  void leave_out(const Eigen::ArrayXd& energies, const Eigen::MatrixXd& own, double observations);

  [[nodiscard]] double error_at(double eta) const;

  /// Of each channel.
  [[nodiscard]] Eigen::Array3d squared_bias(const left_out& material, const Eigen::VectorXd& d) const;

  Eigen::VectorXd values_;        // l, ascending
  Eigen::MatrixXd vectors_;       // V
  Eigen::MatrixXd norm_;          // V'M V
  Eigen::MatrixXd noise_energy_;  // element by element V'M V times the noise in V'A'W y
  Eigen::VectorXd shift_;         // of V'A'W y
  std::vector<left_out> materials_;
  thread_count threads_;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/left_out_error.ipp>
#endif
