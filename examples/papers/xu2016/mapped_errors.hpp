#pragma once
/// What reconstructions from thousands of sets of measurements miss, without expanding a single table.

#include <gonio/basis/pca.hpp>
#include <gonio/model/analytic_brdf.hpp>
#include <gonio/solve/least_squares_problem.hpp>
#include <gonio/table/material_set.hpp>
#include <gonio/table/sample_set.hpp>

#include <Eigen/Core>

#include <span>
#include <vector>

namespace papers {

/// Errors in the mapped domain of materials that are reconstructed by Tikhonov's penalty from their values at some
/// cells: root mean square over all cells, one row a material and one column a colour channel.
///
/// The components are orthogonal: |x - mu - Q c|^2 is what their projection misses plus |Sigma (c - c of the
/// projection)|^2, so only the weights c have to be found. Reflectance that would be negative is not clamped, of which
/// `gonio-papers directions` sees the difference: below 0.001.
class mapped_errors {
 public:
  /// The truths must be over the prior's cells.
  mapped_errors(gonio::log_relative_pca prior, const gonio::material_set& truths, double eta,
                gonio::thread_count threads = {});

  [[nodiscard]] const gonio::log_relative_pca& prior() const noexcept { return prior_; }
  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }

  /// From the cells next to directions, where a cell that is met twice counts twice.
  [[nodiscard]] Eigen::ArrayX3d from(std::span<const gonio::half_difference> directions) const;

  /// What these measurements leave to solve: n x k, one right-hand side a channel of each material.
  [[nodiscard]] gonio::least_squares_problem problem_of(std::span<const gonio::half_difference> directions) const;

  /// Of the components' weights, k x 3m, whoever found them.
  [[nodiscard]] Eigen::ArrayX3d of_weights(const Eigen::MatrixXd& weights) const;

  /// What a material shows at the cells next to directions, which are the samples' own.
  [[nodiscard]] gonio::sample_set measured(std::size_t material,
                                           std::span<const gonio::half_difference> directions) const;

  /// Of other estimates than this prior's, one for each material.
  [[nodiscard]] Eigen::ArrayX3d of(const std::vector<gonio::model::analytic_brdf>& estimates,
                                   gonio::thread_count threads) const;

  /// The lower bound: the projection of the whole table.
  [[nodiscard]] Eigen::ArrayX3d from_all() const;

  /// The upper one: nothing measured, the mean of the database.
  [[nodiscard]] Eigen::ArrayX3d from_nothing() const;

 private:
  [[nodiscard]] Eigen::ArrayX3d root_mean_square(const Eigen::ArrayXd& squares) const;

  gonio::log_relative_pca prior_;
  std::vector<std::string> names_;
  double eta_;
  Eigen::MatrixXf centred_;    ///< the mapped truths minus the mean, 3 columns a material: cells x 3m
  Eigen::MatrixXd projected_;  ///< weights of their projections: k x 3m
  Eigen::ArrayXd missed_;      ///< squares of what the projections miss: 3m
};

}  // namespace papers
