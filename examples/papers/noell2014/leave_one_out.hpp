#pragma once
/// Reconstructs each material of a database from all other materials (Noell, Koehler and Stricker 2014, section 2). In
/// this way, the paper obtains its correction functions, and also the linear combination from full data with which it
/// compares.

#include <gonio/basis/measured.hpp>
#include <gonio/estimate/decomposition.hpp>

#include <Eigen/Core>

#include <array>

namespace papers {

/// Fits each material of a basis by the other ones, over all cells, with weight 1. The first fit computes the Gram
/// matrices of the three channels, O(cells size^2). Later fits use these matrices and only cost the solver.
///
/// ```cpp
/// const papers::leave_one_out_decomposition others{gonio::measured{materials, gonio::log{}}, gonio::nnls{}};
/// const auto chrome = others.reconstruct(materials.find("chrome"));   // chrome from everything but chrome
/// ```
template <gonio::error_metric Metric, gonio::normal_solver Solver>
class leave_one_out_decomposition {
 public:
  explicit leave_one_out_decomposition(gonio::measured<Metric> basis, Solver solver = Solver(),
                                       gonio::thread_count threads = {})
      : basis_(std::move(basis)), solver_(std::move(solver)), threads_(threads) {}

  [[nodiscard]] const gonio::measured<Metric>& basis() const noexcept { return basis_; }

  /// Returns the normal equations of one channel of a material over all other materials that the basis includes.
  [[nodiscard]] gonio::normal_equations problem(Eigen::Index material, Eigen::Index channel) const {
    return gonio::leave_one_out(basis_.channel(channel).products(threads_), material, others(material));
  }

  /// Reconstructs a material from all others. Throws gonio::error if there are no others, or if the solver gives up.
  [[nodiscard]] gonio::fitted_brdf<gonio::measured<Metric>> reconstruct(Eigen::Index material) const {
    const std::vector<Eigen::Index> columns = others(material);
    std::array<gonio::solution, 3> found;
    for (Eigen::Index c = 0; c < 3; ++c) found[c] = solver_.solve(problem(material, c));
    return {basis_, gonio::scatter_columns(gonio::concatenate_columns(found), columns, basis_.size())};
  }

 private:
  [[nodiscard]] std::vector<Eigen::Index> others(Eigen::Index material) const {
    std::vector<Eigen::Index> columns = gonio::columns_of(basis_);
    std::erase(columns, material);
    return columns;
  }

  gonio::measured<Metric> basis_;
  Solver solver_;
  gonio::thread_count threads_;
};

}  // namespace papers
