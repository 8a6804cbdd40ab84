#pragma once
/// Combinations of measured materials (Noell, Koehler and Stricker 2014, Eq. 7-11) for many surfaces that are measured
/// in the same directions: the normal equations' matrix depends on the directions alone and is built once.

#include <gonio/basis/measured.hpp>
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/estimate/sampled_functions.hpp>
#include <gonio/solve/nnls.hpp>

#include <Eigen/Core>

#include <array>
#include <memory>
#include <utility>
#include <vector>

namespace gonio {

/// Fits measurements at locations that are given beforehand, each of weight 1. What `decomposition` does for the same
/// samples, up to float products in the matrix (docs/results/solvers.md); a reconstruction then reads the materials at
/// the locations once.
///
/// ```cpp
/// const auto plan = gonio::locate_samples(materials.cells(), first_surface).at;
/// const gonio::planned_decomposition combination{materials, plan};
/// const auto chrome = combination.without({"chrome"}).reconstruct(measurements_of_chrome);
/// ```
template <error_metric Metric, normal_solver Solver = nnls>
class planned_decomposition {
 public:
  /// `locations` must be on the materials' cells. O(locations materials^2).
  planned_decomposition(measured<Metric> materials, std::vector<location> locations, Solver solver = {},
                        thread_count threads = {})
      : materials_(std::move(materials)),
        solver_(std::move(solver)),
        threads_(threads),
        plan_(std::make_shared<const plan>(materials_, std::move(locations), threads)) {}

  /// The same plan for combinations without these materials. Nothing is copied. Throws gonio::error for a name that
  /// there is not, or if none is left.
  [[nodiscard]] planned_decomposition without(const std::vector<std::string>& excluded) const {
    planned_decomposition fewer(*this);
    fewer.materials_ = materials_.without(excluded);
    return fewer;
  }

  /// From reflectance in sr^-1 at the locations, 3 x n. Throws gonio::error if there are not as many, or one is not
  /// finite, or if the solver gives up. O(locations materials).
  [[nodiscard]] fitted_brdf<measured<Metric>> reconstruct(const channel_values& values) const {
    const auto count = std::ssize(plan_->locations);
    if (values.cols() != count) refuse({"there are ", values.cols(), " measurements at ", count, " planned locations"});
    if (!values.isFinite().all()) refuse("a measurement at a planned place is not finite");
    const channel_values right_hand_sides = map_values(materials_.metric(), values, plan_->locations, threads_);
    const Eigen::MatrixXd rhs = plan_->functions.rhs(channel_values::Ones(3, count), right_hand_sides);
    const Eigen::VectorXd energies = right_hand_sides.cast<double>().square().rowwise().sum();
    const std::vector<Eigen::Index> columns = columns_of(materials_);
    std::array<solution, 3> found;
    for (Eigen::Index c = 0; c < 3; ++c) {
      const normal_equations normal{plan_->grams[c], rhs.col(c), energies.segment<1>(c)};
      found[c] = solver_.solve(normal.subset(columns));
    }
    return {materials_, scatter_columns(concatenate_columns(found), columns, materials_.size())};
  }

 private:
  struct plan {
    plan(const measured<Metric>& materials, std::vector<location> at, thread_count threads)
        : locations(std::move(at)), functions(materials, locations, threads) {
      const Eigen::ArrayXf ones = Eigen::ArrayXf::Ones(std::ssize(locations));
      for (Eigen::Index c = 0; c < 3; ++c) grams[c] = functions.normal(c, ones, ones).gram();
    }

    std::vector<location> locations;
    sampled_functions<measured<Metric>> functions;
    std::array<Eigen::MatrixXd, 3> grams;
  };

  measured<Metric> materials_;
  Solver solver_;
  thread_count threads_;
  std::shared_ptr<const plan> plan_;
};

}  // namespace gonio
