#pragma once
/// Bodies of texels/texel_decomposition.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/estimate/sample_process.hpp>
#include <gonio/solve/product.hpp>
#include <gonio/solve/symmetric_eigen.hpp>
#include <gonio/texels/texel_decomposition.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace gonio {

namespace detail {

/// Number of texels that are solved at once: few enough for their values to stay in the cache.
inline constexpr Eigen::Index texels_at_once = 512;

/// Throws gonio::error that names the first non-finite value of an image in a range of texels.
[[gnu::cold]] GONIO_INLINE void refuse_texel(const float_matrix_view& reflectance, Eigen::Index image, block texels) {
  for (Eigen::Index i = 3 * texels.begin; i < 3 * texels.end; ++i)
    if (!std::isfinite(reflectance(i, image)))
      refuse({"the value of texel ", i / 3, " in image ", image, " is ", double{reflectance(i, image)},
              ", expected a finite number"});
}

}  // namespace detail

GONIO_INLINE texel_decomposition::texel_decomposition(const log_relative_pca& prior,
                                                      const std::vector<location>& locations, const tikhonov& penalty)
    : scale_(std::ssize(locations)), offset_(std::ssize(locations)) {
  if (locations.empty()) refuse("a decomposition of texels needs at least one image");
  const Eigen::Index n = images(), k = prior.size();
  const log_relative& metric = prior.metric();
  for (Eigen::Index i = 0; i < n; ++i) {
    const location& at = locations[i];
    const double weight = metric.cosine_weight(at.cosine);
    scale_[i] = static_cast<float>(weight);
    offset_[i] =
        static_cast<float>(std::log(metric.reference(at) * weight + log_relative::epsilon) + offset_at(prior, at));
  }
  // If the covariance consists of components and errors of the variance eta / m alone, K is m times the covariance of
  // the images.
  const double observations = prior.observations();
  const expected_covariance expected{observations, {.variance = 0.0, .error_variance = penalty.eta() / observations}};
  const located_samples nothing{locations, Eigen::MatrixXd(n, 0), Eigen::MatrixXd::Ones(n, 1)};
  const sample_process process(expected, locate_rows(prior, locations), nothing,
                               Eigen::VectorXd::Constant(n, expected.model.error_variance));
  const Eigen::MatrixXd& rows = process.at().rows;
  // A A' = U S^2 U'.
  const symmetric_eigen gram = decompose_symmetric(product_with_transpose(rows), "the products of the images' rows");
  const Eigen::ArrayXd squares = gram.values.array().max(0.0), penalised = squares + penalty.eta();
  const double largest = squares.maxCoeff();
  if (!(penalised.minCoeff() > 1e-14 * largest))
    refuse({"eta is ", penalty.eta(), ", too small for ", n, " images: rounding leaves no optimum"});
  const Eigen::Index r = std::max<Eigen::Index>((squares > 1e-12 * largest).count(), 1);
  // The largest eigenvalues are the last.
  const Eigen::ArrayXd scales = squares.tail(r).sqrt().max(std::numeric_limits<double>::min());
  const Eigen::MatrixXd spanning = gram.vectors.rightCols(r);
  functions_ = (product(rows.transpose(), spanning) * scales.inverse().matrix().asDiagonal()).cast<float>();
  // Scale the leave-one-out residuals to an expected variance of 1.
  const Eigen::MatrixXd inverse = process.inverse() / observations;
  const Eigen::ArrayXd deviations = (inverse.diagonal().array() / observations).sqrt();
  products_.resize(r + n, n);
  products_.topRows(r) = ((scales / penalised.tail(r)).matrix().asDiagonal() * spanning.transpose()).cast<float>();
  for (Eigen::Index i = 0; i < n; ++i) products_.row(r + i) = (inverse.row(i) / deviations[i]).cast<float>();
  mahalanobis_weights_ = (observations * deviations).matrix().transpose().cast<float>();
  // Average the variance over all cells. Over all cells, the components are orthogonal, and their norms are the
  // singular values.
  const Eigen::MatrixXd weights = product(rows.transpose(), inverse);
  double variance = penalty.eta() / observations;
  const auto cells = static_cast<double>(prior.cells().size());
  for (Eigen::Index j = 0; j < k; ++j)
    variance += std::max(1.0 - weights.row(j).dot(rows.col(j)), 0.0) / observations *
                std::pow(prior.singular_values()[j], 2) / cells;
  deviation_ = static_cast<float>(std::sqrt(variance));
}

GONIO_INLINE Eigen::MatrixXf texel_decomposition::mapped(const float_matrix_view& reflectance, block texels) const {
  Eigen::MatrixXf values(images(), 3 * texels.size());
  Eigen::ArrayXf image(values.cols());
  for (Eigen::Index i = 0; i < images(); ++i) {
    image = reflectance.col(i).segment(3 * texels.begin, image.size());
    if (!((image * 0.0f).sum() == 0.0f)) detail::refuse_texel(reflectance, i, texels);
    image = (image.max(0.0f) * scale_[i] + static_cast<float>(log_relative::epsilon)).log() - offset_[i];
    values.row(i) = image.transpose();
  }
  return values;
}

GONIO_INLINE void texel_decomposition::solve_block(const float_matrix_view& reflectance, block texels,
                                                   texel_estimates& found) const {
  const Eigen::Index n = images(), r = functions_.cols();
  const Eigen::MatrixXf values = mapped(reflectance, texels);
  const Eigen::MatrixXf results = product(products_, values);
  found.weights.middleCols(3 * texels.begin, results.cols()) = results.topRows(r);
  constexpr auto before = static_cast<float>(sample_process::known_before);
  const auto of_all = static_cast<float>(n);
  for (Eigen::Index t = 0; t < texels.size(); ++t) {
    float squares = 0.0f, mahalanobis = 0.0f;
    for (Eigen::Index j = 3 * t; j < 3 * t + 3; ++j) {
      const auto residuals = results.col(j).tail(n);
      squares += residuals.squaredNorm();
      mahalanobis += values.col(j).cwiseProduct(residuals).dot(mahalanobis_weights_);
    }
    found.disagreement[texels.begin + t] = std::sqrt(squares / (3.0f * of_all));
    const float scale = (before + std::max(mahalanobis, 0.0f) / 3.0f) / (before + of_all);
    found.uncertainty[texels.begin + t] = deviation_ * std::sqrt(scale);
  }
}

GONIO_INLINE texel_estimates texel_decomposition::solve(const float_matrix_view& reflectance,
                                                        thread_count threads) const {
  if (reflectance.cols() != images() || reflectance.rows() % 3 != 0)
    refuse({"there are ", reflectance.cols(), " images of ", reflectance.rows(), " numbers, expected ", images(),
            " images with three numbers for each texel"});
  const Eigen::Index texels = reflectance.rows() / 3;
  texel_estimates found{Eigen::MatrixXf(functions_.cols(), 3 * texels), Eigen::ArrayXf(texels), Eigen::ArrayXf(texels)};
  for_each_block(
      texels, detail::texels_at_once, [&](block some) { solve_block(reflectance, some, found); }, threads);
  return found;
}

}  // namespace gonio
