#pragma once
/// Reconstructs the texels of a flat sample from n images, each with one pair of directions for all texels. Nielsen et
/// al. 2015 (doi:10.1145/2816795.2818085), Eq. 11-12. The matrix depends only on the directions, so one factorisation
/// and one product solve all texels.
///
/// Let A be the n rows of k components, m the number of the prior's observations, K = A A' + eta I, and y the mapped
/// values of a texel's channel, minus the prior's mean. Then the weights are x = A' K^-1 y, combinations of the n rows.
/// With A = U S V' of rank r, the r columns of V span them, and V' x = S (S^2 + eta I)^-1 U' y represents x with fewer
/// numbers. Under the prior, y has the covariance K / m. This gives the prediction of each image from the others
/// (leave-one-out residuals: Rasmussen and Williams 2006, Eq. 5.12) and the uncertainty of an estimate.

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
  /// t values: the difference of each image from its prediction by the other images, divided by its expected standard
  /// deviation, root mean square over images and channels. About 1 if eta is right for the sample; more if images
  /// contradict each other (a shadow, a misregistered edge) or if the prior does not represent the material.
  Eigen::ArrayXf disagreement;

  /// Marks a texel as outside of the sample by setting its weights, uncertainty and disagreement to zero.
  void clear(Eigen::Index texel) {
    weights.middleCols(3 * texel, 3).setZero();
    uncertainty[texel] = disagreement[texel] = 0.0f;
  }
};

/// Computes `decomposition{prior, penalty}` for many texels at once, in single precision. All samples have the weight
/// 1. Weights agree with those of `decomposition` to about 1e-6 of the largest weight
/// (tests/texels/texel_decomposition.cpp requires 1e-5), and to 6e-4 if stored as half floats.
///
/// ```cpp
/// const gonio::texel_decomposition texels(prior, locations_of_images, gonio::tikhonov{eta});
/// const gonio::texel_estimates found = texels.solve(reflectance);
/// ```
class texel_decomposition {
 public:
  /// `locations` must be on the prior's cells, one for each image. Throws gonio::error if there is none, or if eta is
  /// so small that rounding leaves no optimum. O(n^2 (n + k)).
  texel_decomposition(const log_relative_pca& prior, const std::vector<location>& locations, const tikhonov& penalty);

  /// Returns the number of images n.
  [[nodiscard]] Eigen::Index images() const noexcept { return scale_.size(); }
  /// Returns V, k x r. V times the weights that `solve` returns are the weights of the prior's k components.
  [[nodiscard]] const Eigen::MatrixXf& functions() const noexcept { return functions_; }

  /// Solves for t texels. `reflectance` is 3t x n, in sr^-1: a column is an image, with red, green and blue of the
  /// first texel, then of the second texel, and so on. Negative reflectance counts as zero, as in the metric. Throws
  /// gonio::error naming image and texel of the first value that is not finite, or if the size is wrong. The bytes do
  /// not depend on the number of threads. O(t n (n + r)).
  [[nodiscard]] texel_estimates solve(const float_matrix_view& reflectance, thread_count threads = {}) const;

 private:
  /// Returns the mapped values of a range of texels minus the prior's mean: n x 3 texels.
  [[nodiscard]] Eigen::MatrixXf mapped(const float_matrix_view& reflectance, block texels) const;
  void solve_block(const float_matrix_view& reflectance, block texels, texel_estimates& found) const;

  Eigen::ArrayXf scale_, offset_;  ///< for each image: the mapped value is ln(scale max(rho, 0) + epsilon) - offset
  Eigen::MatrixXf functions_;
  Eigen::MatrixXf products_;  ///< (r + n) x n: V' A' K^-1; below it K^-1, scaled for residuals of variance 1
  Eigen::RowVectorXf mahalanobis_weights_;  ///< the sum of y times the residuals with these weights is m y' K^-1 y
  float deviation_ = 0.0f;  ///< deviation of a mapped value given the images: rms over all cells, for a scale of 1
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/texels/impl/texel_decomposition.ipp>
#endif
