#include "../synthetic_materials.hpp"
#include <gonio/estimate/decomposition.hpp>
#include <gonio/solve/tikhonov.hpp>
#include <gonio/texels/texel_decomposition.hpp>

#include <Eigen/Cholesky>
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace {

/// Texels that blend from one material to another, with noise, in the same directions.
struct textured_sample {
  gonio::log_relative_pca prior = learn(synthetic_materials(small_cells(), 20), 12);
  std::vector<gonio::location> locations;
  Eigen::MatrixXf images;

  textured_sample(Eigen::Index texels, Eigen::Index n, double noise) : images(3 * texels, n) {
    for (Eigen::Index i = 0; i < n; ++i) {
      auto angles = small_cells().angles((17 * i + 3) % small_cells().size());
      angles.theta_d *= 0.98;
      locations.push_back(gonio::locate(small_cells(), angles));
    }
    const auto set = synthetic_materials(small_cells(), 6, 11);
    std::mt19937 generator(5);
    std::normal_distribution<double> error;
    for (Eigen::Index i = 0; i < n; ++i) {
      const gonio::rgb one = set.table(1).at(locations[i]), other = set.table(4).at(locations[i]);
      for (Eigen::Index t = 0; t < texels; ++t) {
        const double share = 0.5 + 0.5 * std::sin(0.01 * static_cast<double>(t));
        for (Eigen::Index c = 0; c < 3; ++c)
          images(3 * t + c, i) =
              static_cast<float>((share * one[c] + (1.0 - share) * other[c]) * (1.0 + noise * error(generator)));
      }
    }
  }

  [[nodiscard]] gonio::sample_set samples_of(Eigen::Index texel) const {
    gonio::sample_set samples;
    for (Eigen::Index i = 0; i < images.cols(); ++i)
      samples.push_back({locations[i].angles, images.col(i).segment<3>(3 * texel).cast<double>().array(), 1.0});
    return samples;
  }
};

}  // namespace

TEST_CASE("texels: the weights are those of a decomposition of each texel") {
  for (const Eigen::Index n : {5, 20, 40})  // fewer and more images than components
    for (const double eta : {0.5, 40.0}) {
      CAPTURE(n);
      CAPTURE(eta);
      const textured_sample sample(1100, n, 0.02);
      const gonio::texel_decomposition texels(sample.prior, sample.locations, gonio::tikhonov{eta});
      CHECK(texels.images() == n);
      CHECK(texels.functions().rows() == 12);
      CHECK(texels.functions().cols() == std::min<Eigen::Index>(n, 12));
      const auto found = texels.solve(sample.images);
      const gonio::decomposition one_by_one{sample.prior, gonio::tikhonov{eta}};
      for (Eigen::Index t = 0; t < 1100; t += 37) {
        const Eigen::MatrixXd expected = one_by_one.fit(sample.samples_of(t)).weights();
        const Eigen::MatrixXd weights = (texels.functions() * found.weights.middleCols<3>(3 * t)).cast<double>();
        CHECK((weights - expected).cwiseAbs().maxCoeff() < 1e-5 * expected.cwiseAbs().maxCoeff());
      }
    }
}

TEST_CASE("texels: disagreement is that of images left out one by one, and uncertainty grows with it") {
  const Eigen::Index n = 8;
  const textured_sample sample(3, n, 0.1);
  const double eta = 2.0;
  const auto found =
      gonio::texel_decomposition(sample.prior, sample.locations, gonio::tikhonov{eta}).solve(sample.images);
  const auto m = static_cast<double>(sample.prior.coefficients().rows());
  const Eigen::MatrixXd rows = gonio::rows_at(sample.prior, sample.locations);
  const auto mapped = [&](Eigen::Index t, Eigen::Index c, Eigen::Index i) {
    return sample.prior.metric().forward(double{sample.images(3 * t + c, i)}, sample.locations[i]) -
           gonio::offset_at(sample.prior, sample.locations[i]);
  };
  for (Eigen::Index t = 0; t < 3; ++t) {
    double squares = 0.0;
    for (Eigen::Index out = 0; out < n; ++out) {
      auto samples = sample.samples_of(t);
      samples.erase(samples.begin() + out);
      const Eigen::MatrixXd weights = gonio::decomposition{sample.prior, gonio::tikhonov{eta}}.fit(samples).weights();
      Eigen::MatrixXd others(n - 1, rows.cols());
      others << rows.topRows(out), rows.bottomRows(n - 1 - out);
      const Eigen::MatrixXd precision =
          others.transpose() * others + eta * Eigen::MatrixXd::Identity(rows.cols(), rows.cols());
      const double variance = eta / m * (1.0 + rows.row(out).dot(precision.ldlt().solve(rows.row(out).transpose())));
      for (Eigen::Index c = 0; c < 3; ++c)
        squares += std::pow(mapped(t, c, out) - rows.row(out).dot(weights.col(c)), 2) / variance;
    }
    CHECK(found.disagreement[t] == doctest::Approx(std::sqrt(squares / (3.0 * n))).epsilon(1e-3));
  }
  auto wrong = sample.images;
  wrong.col(2).segment<3>(3) *= 20.0f;
  const auto other = gonio::texel_decomposition(sample.prior, sample.locations, gonio::tikhonov{eta}).solve(wrong);
  CHECK(other.disagreement[1] > 2.0f * found.disagreement[1]);
  CHECK(other.uncertainty[1] > found.uncertainty[1]);
  CHECK(other.disagreement[0] == found.disagreement[0]);
}

TEST_CASE("texels: the uncertainty is the posterior's over all cells, scaled by what the texel shows") {
  const textured_sample sample(2, 6, 0.0);
  const double eta = 3.0;
  const auto found =
      gonio::texel_decomposition(sample.prior, sample.locations, gonio::tikhonov{eta}).solve(sample.images);
  const auto m = static_cast<double>(sample.prior.coefficients().rows());
  const Eigen::MatrixXd rows = gonio::rows_at(sample.prior, sample.locations);
  const Eigen::Index k = rows.cols();
  const Eigen::MatrixXd precision = rows.transpose() * rows / eta + Eigen::MatrixXd::Identity(k, k);
  const Eigen::MatrixXd covariance = precision.ldlt().solve(Eigen::MatrixXd::Identity(k, k)) / m;
  double variance = eta / m;
  const Eigen::MatrixXd all = sample.prior.components().cast<double>();
  for (Eigen::Index cell = 0; cell < all.rows(); ++cell)
    variance += (all.row(cell) * covariance * all.row(cell).transpose()).value() / static_cast<double>(all.rows());
  const Eigen::MatrixXd of_images = (rows * rows.transpose() + eta * Eigen::MatrixXd::Identity(6, 6)) / m;
  double mahalanobis = 0.0;
  for (Eigen::Index c = 0; c < 3; ++c) {
    Eigen::VectorXd y(6);
    for (Eigen::Index i = 0; i < 6; ++i)
      y[i] = sample.prior.metric().forward(double{sample.images(3 + c, i)}, sample.locations[i]) -
             gonio::offset_at(sample.prior, sample.locations[i]);
    mahalanobis += y.dot(of_images.ldlt().solve(y)) / 3.0;
  }
  CHECK(found.uncertainty[1] == doctest::Approx(std::sqrt(variance * (10.0 + mahalanobis) / 16.0)).epsilon(1e-3));
}

TEST_CASE("texels: the same bytes for any number of threads and any cut of the image at whole blocks") {
  const textured_sample sample(2000, 10, 0.05);
  const gonio::texel_decomposition texels(sample.prior, sample.locations, gonio::tikhonov{1.0});
  const auto one = texels.solve(sample.images, {1}), three = texels.solve(sample.images, {3});
  CHECK(one.weights == three.weights);
  CHECK((one.uncertainty == three.uncertainty).all());
  const auto part = texels.solve(sample.images.middleRows(3 * 512, 3 * 700));
  CHECK((part.weights - one.weights.middleCols(3 * 512, 3 * 700)).cwiseAbs().maxCoeff() < 1e-6f);
}

TEST_CASE("texels: values that are not finite, other sizes and no images are refused") {
  textured_sample sample(600, 4, 0.0);
  const gonio::texel_decomposition texels(sample.prior, sample.locations, gonio::tikhonov{1.0});
  CHECK_THROWS_WITH_AS((void)texels.solve(sample.images.leftCols(3)), doctest::Contains("3 images"), gonio::error);
  CHECK_THROWS_WITH_AS((void)texels.solve(sample.images.topRows(7)), doctest::Contains("7 numbers"), gonio::error);
  CHECK(texels.solve(sample.images.topRows(0)).weights.cols() == 0);
  sample.images(3 * 551 + 1, 2) = std::nanf("");
  CHECK_THROWS_WITH_AS((void)texels.solve(sample.images), doctest::Contains("texel 551 in image 2"), gonio::error);
  sample.images(3 * 551 + 1, 2) = std::numeric_limits<float>::infinity();
  CHECK_THROWS_AS((void)texels.solve(sample.images), gonio::error);
  sample.images(3 * 551 + 1, 2) = -1.0f;  // counts as zero
  CHECK(texels.solve(sample.images).weights.allFinite());
  CHECK_THROWS_AS(gonio::texel_decomposition(sample.prior, {}, gonio::tikhonov{1.0}), gonio::error);
}
