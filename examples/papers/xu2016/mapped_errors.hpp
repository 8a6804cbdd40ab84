#pragma once
/// Errors of reconstructions from thousands of sets of measurements, without expanding any table.

#include <gonio/basis/pca.hpp>
#include <gonio/model/analytic_brdf.hpp>
#include <gonio/solve/least_squares_problem.hpp>
#include <gonio/table/material_set.hpp>
#include <gonio/table/sample_set.hpp>

#include <Eigen/Core>

#include <span>
#include <vector>

namespace papers {

/// Errors in the mapped domain of materials reconstructed with Tikhonov's penalty from their values at some cells: root
/// mean square over all cells, one row per material and one column per channel.
///
/// The components are orthogonal: |x - mu - Q c|^2 is the squared residual of the projection plus |Sigma (c - p)|^2,
/// where p are the weights of the projection. So only the weights c have to be found. Negative reflectance is not
/// clamped. Compared with `gonio-papers directions`, this changes the errors by less than 0.001.
class mapped_errors {
 public:
  /// The truths must share the prior's cells.
  mapped_errors(gonio::log_relative_pca prior, const gonio::material_set& truths, double eta,
                gonio::thread_count threads = {});

  [[nodiscard]] const gonio::log_relative_pca& prior() const noexcept { return prior_; }
  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }

  /// Returns errors from the cells nearest to directions. A repeated cell counts repeatedly.
  [[nodiscard]] Eigen::ArrayX3d from(std::span<const gonio::half_difference> directions) const;

  /// Returns the least-squares problem of measurements in these directions: one row per direction, one right-hand side
  /// per channel and material.
  [[nodiscard]] gonio::least_squares_problem problem_of(std::span<const gonio::half_difference> directions) const;

  /// Returns the errors of reconstructions with given weights. `weights` has one row per component and three columns
  /// per material.
  [[nodiscard]] Eigen::ArrayX3d of_weights(const Eigen::MatrixXd& weights) const;

  /// Returns a material's values at the cells nearest to directions. The samples have the cells' directions.
  [[nodiscard]] gonio::sample_set measured(std::size_t material,
                                           std::span<const gonio::half_difference> directions) const;

  /// Returns the errors of other estimates, one per material.
  [[nodiscard]] Eigen::ArrayX3d of(const std::vector<gonio::model::analytic_brdf>& estimates,
                                   gonio::thread_count threads) const;

  /// Returns a lower bound of the errors: the errors of the whole table's projection.
  [[nodiscard]] Eigen::ArrayX3d from_all() const;

  /// Returns the errors without any measurement: the errors of the database's mean.
  [[nodiscard]] Eigen::ArrayX3d from_nothing() const;

 private:
  [[nodiscard]] Eigen::ArrayX3d root_mean_square(const Eigen::ArrayXd& squares) const;

  gonio::log_relative_pca prior_;
  std::vector<std::string> names_;
  double eta_;
  Eigen::MatrixXf centred_;    ///< the mapped truths minus the mean, 3 columns per material: cells x 3m
  Eigen::MatrixXd projected_;  ///< weights of their projections: k x 3m
  Eigen::ArrayXd missed_;      ///< squared norms of the projections' residuals: 3m
};

}  // namespace papers
