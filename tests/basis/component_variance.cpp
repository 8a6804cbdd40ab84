#include "../synthetic_materials.hpp"
#include <gonio/basis/component_variance.hpp>
#include <gonio/metric/lin.hpp>

#include <doctest/doctest.h>

#include <cmath>

TEST_CASE("a deviation is that of a column about its mean, over all materials and channels") {
  Eigen::MatrixXf coefficients(4, 3);
  coefficients << 1, 5, 0, 3, 5, 0, 1, 5, 0, 3, 5, 4;
  const Eigen::VectorXd deviations = gonio::weight_deviations(coefficients);
  REQUIRE(deviations.size() == 3);
  CHECK(deviations[0] == 1.0);
  CHECK(deviations[1] == 0.0);
  CHECK(deviations[2] == doctest::Approx(std::sqrt(3.0)).epsilon(1e-14));
}

TEST_CASE("the weights of learned components have the variance 1 / (3 materials), whatever the materials") {
  for (const std::size_t count : {4, 9}) {
    const auto prior = learn(synthetic_materials(small_cells(), count), 5);
    for (const double deviation : gonio::weight_deviations(prior.coefficients()))
      CHECK(deviation == doctest::Approx(1.0 / std::sqrt(3.0 * static_cast<double>(count))).epsilon(1e-4));
  }
}

TEST_CASE("shares of the variance fall, and add up to the explained variance, also for a truncated basis") {
  const auto prior = learn(synthetic_materials(small_cells(), 9), 7);
  for (const auto& basis : {prior, prior.truncated(3)}) {
    const Eigen::VectorXd shares = gonio::variance_shares(basis);
    REQUIRE(shares.size() == basis.size());
    CHECK(shares.sum() == doctest::Approx(basis.explained_variance()).epsilon(1e-12));
    for (Eigen::Index j = 1; j < shares.size(); ++j) CHECK(shares[j] <= shares[j - 1]);
  }
  CHECK(gonio::variance_shares(prior.truncated(3))[2] ==
        doctest::Approx(gonio::variance_shares(prior)[2]).epsilon(1e-12));
}

TEST_CASE("a share is that of the squared differences from the mean, counted anew") {
  const auto set = synthetic_materials(small_cells(), 6);
  const auto prior = gonio::learn_pca(set, gonio::lin(), 3);
  const Eigen::MatrixXd values = set.values.cast<double>();
  const Eigen::MatrixXd centred = values.colwise() - values.rowwise().mean();
  const Eigen::MatrixXd explained = prior.components().cast<double>() * prior.coefficients().cast<double>().transpose();
  const Eigen::VectorXd shares = gonio::variance_shares(prior);
  for (Eigen::Index j = 0; j < 3; ++j) {
    const Eigen::MatrixXd part =
        prior.components().col(j).cast<double>() * prior.coefficients().col(j).cast<double>().transpose();
    CHECK(part.squaredNorm() / centred.squaredNorm() == doctest::Approx(shares[j]).epsilon(1e-4));
  }
  CHECK(explained.squaredNorm() / centred.squaredNorm() == doctest::Approx(shares.sum()).epsilon(1e-4));
}
