#pragma once
/// Spatially varying samples: many points of a flat sample, texels, measured in the same n direction pairs, with an
/// image for each. Nielsen et al. 2015 (doi:10.1145/2816795.2818085), Eq. 11-12. The matrix depends on the directions
/// alone, so that one factorisation, and then a product, solve all texels.
///
/// With A the n rows of k components, m the prior's observations and K = A A' + eta I, the weights of the mapped values
/// y of a texel's channel are x = A' K^-1 y. All x are combinations of the n rows. With A = U S V', the r = min(n, k)
/// columns of V span them, and V' x = S (S^2 + eta I)^-1 U' y represents x with fewer numbers. Under the prior, y has
/// the covariance K / m. It gives the prediction of each image from the others (leave-one-out residuals: Rasmussen and
/// Williams 2006, Eq. 5.12) and the uncertainty of an estimate.

#include <gonio/basis/pca.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/solve/float_product.hpp>
#include <gonio/solve/tikhonov.hpp>
#include <gonio/table/location.hpp>

#include <Eigen/Core>

#include <vector>

namespace gonio {

/// The estimates of t texels.
struct texel_estimates {
  Eigen::MatrixXf weights;  ///< r x 3t: column 3i + c has the weights V' x of channel c of texel i
  /// t values: the standard deviation of a mapped value, root mean square over all cells of the prior, in natural
  /// logarithms: 0.06 is 6 %. Zero for texels outside of the sample, otherwise positive.
  Eigen::ArrayXf uncertainty;
  /// t values: the difference of each image from its prediction by the others, in expected deviations, root mean square
  /// over images and channels. About 1 if eta is right for the sample; more if images contradict each other (a shadow,
  /// a misregistered edge) or if the prior does not represent the material.
  Eigen::ArrayXf disagreement;

  /// Marks a texel as outside of the sample: sets everything to zero.
  void clear(Eigen::Index texel) {
    weights.middleCols(3 * texel, 3).setZero();
    uncertainty[texel] = disagreement[texel] = 0.0f;
  }
};

/// `decomposition{prior, penalty}` of samples of weight 1 for many texels at once, in single precision. Weights agree
/// to about 1e-6 of the largest, and as half floats to 6e-4 (tests/texels/texel_decomposition.cpp requires 1e-5).
///
/// ```cpp
/// const gonio::texel_decomposition texels(prior, locations_of_images, gonio::tikhonov{eta});
/// const gonio::texel_estimates found = texels.solve(images);
/// ```
class texel_decomposition {
 public:
  /// `locations` must be on the prior's cells, one for each image. Throws gonio::error if there is none, or if eta is
  /// so small that rounding leaves no optimum. O(n^2 (n + k)).
  texel_decomposition(const log_relative_pca& prior, const std::vector<location>& locations, const tikhonov& penalty);

  /// Returns the number of images n.
  [[nodiscard]] Eigen::Index images() const noexcept { return scale_.size(); }
  /// Returns V, k x r: the weights of the prior's components are V times the result of `solve`.
  [[nodiscard]] const Eigen::MatrixXf& functions() const noexcept { return functions_; }

  /// Solves for reflectance in sr^-1, 3t x n: a column is an image, with red, green and blue of the first texel, then
  /// of the next. Negative reflectance counts as zero, as in the metric. Throws gonio::error naming image and texel of
  /// the first value that is not finite, or if the size is wrong. Same bytes for any number of threads. O(t n (n + r)).
  [[nodiscard]] texel_estimates solve(const float_matrix_view& reflectance, thread_count threads = {}) const;

 private:
  /// Returns the mapped values of a range of texels minus the prior's mean: n x 3 texels.
  [[nodiscard]] Eigen::MatrixXf mapped(const float_matrix_view& reflectance, block texels) const;
  void solve_block(const float_matrix_view& reflectance, block texels, texel_estimates& found) const;

  Eigen::ArrayXf scale_, offset_;  ///< of each image: the mapped value is ln(scale max(rho, 0) + epsilon) - offset
  Eigen::MatrixXf functions_;
  Eigen::MatrixXf products_;  ///< (r + n) x n: V' A' K^-1, and below it K^-1 such that residuals have variance 1
  Eigen::RowVectorXf mahalanobis_weights_;  ///< weights with which these residuals sum to m y' K^-1 y
  float deviation_ = 0.0f;                  ///< prior standard deviation of a mapped value
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/texels/impl/texel_decomposition.ipp>
#endif
