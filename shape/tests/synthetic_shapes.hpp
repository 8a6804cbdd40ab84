#pragma once
/// Small sets of corresponded points for tests: a few random directions of change, and small changes in all directions.

#include <gonio/basis/learn_pca.hpp>
#include <gonio/shape/shape_basis.hpp>

#include <cstdint>
#include <random>
#include <string>
#include <vector>

/// Returns `count` shapes of `vertices` vertices about a mean of size 10. Their changes have `directions` directions of
/// decreasing size, plus random changes of a hundredth.
inline std::vector<gonio::shape::point_columns> synthetic_shapes(Eigen::Index vertices, std::size_t count,
                                                                 Eigen::Index directions, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  const auto numbers = [&](Eigen::Index rows, Eigen::Index columns) {
    Eigen::MatrixXd matrix(rows, columns);
    for (double& number : matrix.reshaped()) number = normal(generator);
    return matrix;
  };
  const Eigen::VectorXd mean = 10.0 * numbers(3 * vertices, 1);
  Eigen::MatrixXd changes = numbers(3 * vertices, directions);
  for (Eigen::Index j = 0; j < directions; ++j) changes.col(j) /= 1.0 + static_cast<double>(j);
  std::vector<gonio::shape::point_columns> shapes;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::VectorXd common = changes * numbers(directions, 1), own = 0.01 * numbers(3 * vertices, 1);
    const Eigen::VectorXd shape = mean + common + own;
    shapes.push_back(shape.reshaped(3, vertices));
  }
  return shapes;
}

inline std::vector<std::string> synthetic_names(std::size_t count) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count; ++i) names.push_back("shape-" + std::to_string(i));
  return names;
}

/// Returns the basis of such shapes with all components.
inline gonio::shape::shape_basis synthetic_basis(const std::vector<gonio::shape::point_columns>& shapes) {
  return gonio::learn_pca(gonio::shape::shape_set::of(shapes, synthetic_names(shapes.size())), gonio::lin{},
                          shapes.size());
}
