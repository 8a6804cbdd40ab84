#pragma once
/// Combinations of measured materials (Noell, Koehler and Stricker 2014, Eq. 7-11) for many surfaces measured in the
/// same directions. The matrix of the normal equations depends only on the directions and is built once.

#include <gonio/basis/measured.hpp>
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/robust/sampled_functions.hpp>
#include <gonio/solve/nnls.hpp>

#include <Eigen/Core>

#include <array>
#include <memory>
#include <utility>
#include <vector>

namespace papers {

/// Fits measurements at locations known in advance, each of weight 1. The results equal those of `decomposition` on the
/// same samples, up to float products in the matrix (docs/results/solvers.md). A reconstruction reads the materials at
/// the locations once.
///
/// ```cpp
/// const auto plan = gonio::locate_samples(materials.cells(), first_surface).locations;
/// const papers::planned_decomposition combination{materials, plan};
/// const auto chrome = combination.without({"chrome"}).reconstruct(measurements_of_chrome);
/// ```
template <gonio::error_metric Metric, gonio::normal_solver Solver = gonio::nnls>
class planned_decomposition {
 public:
  /// `locations` must be on the materials' cells. O(locations materials^2).
  planned_decomposition(gonio::measured<Metric> materials, std::vector<gonio::location> locations, Solver solver = {},
                        gonio::thread_count threads = {})
      : materials_(std::move(materials)),
        solver_(std::move(solver)),
        threads_(threads),
        plan_(std::make_shared<const plan>(materials_, std::move(locations), threads)) {}

  /// Returns the same plan for combinations without these materials. Copies no data. Throws gonio::error if a name does
  /// not exist, or if no material is left.
  [[nodiscard]] planned_decomposition without(const std::vector<std::string>& excluded) const {
    planned_decomposition fewer(*this);
    fewer.materials_ = materials_.without(excluded);
    return fewer;
  }

  /// Reconstructs from reflectance in sr^-1 at the locations, 3 x n. Throws gonio::error if the number differs, a value
  /// is not finite, or the solver gives up. O(locations materials).
  [[nodiscard]] gonio::fitted_brdf<gonio::measured<Metric>> reconstruct(const gonio::channel_values& values) const {
    const auto count = std::ssize(plan_->locations);
    if (values.cols() != count)
      gonio::refuse({"there are ", values.cols(), " measurements at ", count, " planned locations"});
    if (!values.isFinite().all()) gonio::refuse("a measurement at a planned location is not finite");
    const gonio::channel_values right_hand_sides =
        gonio::map_values(materials_.metric(), values, plan_->locations, threads_);
    const Eigen::MatrixXd rhs = plan_->functions.rhs(gonio::channel_values::Ones(3, count), right_hand_sides);
    const Eigen::VectorXd energies = right_hand_sides.cast<double>().square().rowwise().sum();
    const std::vector<Eigen::Index> columns = gonio::columns_of(materials_);
    std::array<gonio::solution, 3> found;
    for (Eigen::Index c = 0; c < 3; ++c) {
      const gonio::normal_equations normal{plan_->grams[c], rhs.col(c), energies.segment<1>(c)};
      found[c] = solver_.solve(normal.subset(columns));
    }
    return {materials_, gonio::scatter_columns(gonio::concatenate_columns(found), columns, materials_.size())};
  }

 private:
  struct plan {
    plan(const gonio::measured<Metric>& materials, std::vector<gonio::location> at, gonio::thread_count threads)
        : locations(std::move(at)), functions(materials, locations, threads) {
      const Eigen::ArrayXf ones = Eigen::ArrayXf::Ones(std::ssize(locations));
      for (Eigen::Index c = 0; c < 3; ++c) grams[c] = functions.normal(c, ones, ones).gram();
    }

    std::vector<gonio::location> locations;
    gonio::sampled_functions<gonio::measured<Metric>> functions;
    std::array<Eigen::MatrixXd, 3> grams;
  };

  gonio::measured<Metric> materials_;
  Solver solver_;
  gonio::thread_count threads_;
  std::shared_ptr<const plan> plan_;
};

}  // namespace papers
