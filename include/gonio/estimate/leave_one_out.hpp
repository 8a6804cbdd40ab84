#pragma once
/// Every material of a database explained by the others: Noell, Koehler and Stricker 2014, section 2, where it
/// generates the correction functions and gives the linear-combination rival its estimate from full data.

#include <gonio/basis/measured.hpp>
#include <gonio/estimate/decomposition.hpp>

#include <Eigen/Core>

#include <array>

namespace gonio {

/// Fits materials of a basis by the other ones, over all cells, with weight 1. The Gram matrices of the three channels
/// are the basis's own: O(cells size^2) for the first fit; after that one touches no data and costs the solver alone.
///
/// ```cpp
/// const gonio::leave_one_out_decomposition others{gonio::measured{materials, gonio::log{}}, gonio::nnls{}};
/// const auto chrome = others.reconstruct(materials.find("chrome"));   // chrome from everything but chrome
/// ```
template <error_metric Metric, normal_solver Solver>
class leave_one_out_decomposition {
 public:
  explicit leave_one_out_decomposition(measured<Metric> basis, Solver solver = Solver(), thread_count threads = {})
      : basis_(std::move(basis)), solver_(std::move(solver)), threads_(threads) {}

  [[nodiscard]] const measured<Metric>& basis() const noexcept { return basis_; }

  /// The normal equations of one channel of one material over those that the basis does not leave out, itself excepted.
  [[nodiscard]] normal_equations problem(Eigen::Index material, Eigen::Index channel) const {
    return leave_one_out(basis_.channel(channel).products(threads_), material, others(material));
  }

  /// A material from all others. Throws gonio::error if it is the only one, or the solver gives up.
  [[nodiscard]] fitted_brdf<measured<Metric>> reconstruct(Eigen::Index material) const {
    const std::vector<Eigen::Index> columns = others(material);
    std::array<solution, 3> found;
    for (Eigen::Index c = 0; c < 3; ++c) found[c] = solver_.solve(problem(material, c));
    return {basis_, scatter_columns(concatenate_columns(found), columns, basis_.size())};
  }

 private:
  [[nodiscard]] std::vector<Eigen::Index> others(Eigen::Index material) const {
    std::vector<Eigen::Index> columns = columns_of(basis_);
    std::erase(columns, material);
    return columns;
  }

  measured<Metric> basis_;
  Solver solver_;
  thread_count threads_;
};

}  // namespace gonio
