#pragma once
/// Basis decomposition: the mapped measurements as a linear combination of a basis' functions.
/// Nielsen et al. 2015, Eq. 9-12 (pca x log-relative x Tikhonov); Noell et al. 2014, Eq. 7-10.

#include <gonio/basis/basis.hpp>
#include <gonio/estimate/estimator.hpp>
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/solve/solver.hpp>

#include <utility>

namespace gonio {

/// Fits each colour channel of a set of samples by a basis, with the weights found by a solver.
///
/// ```cpp
/// const auto paint = gonio::decomposition{prior, gonio::tikhonov{40.0}}.fit(samples);
/// ```
/// Row i of the system is the basis interpolated at sample i, the right-hand side the sample's mapped value
/// minus the offset there (Eq. 9); the sample's weight multiplies its squared error. All channels share
/// one system matrix.
template <basis Basis, solver Solver>
class decomposition {
 public:
  decomposition(Basis basis, Solver solver) : basis_(std::move(basis)), solver_(std::move(solver)) {}

  /// Cost of the solver plus O(samples x size of the basis). Throws gonio::error for unusable samples.
  template <sample_range Samples>
  [[nodiscard]] fitted_brdf<Basis> fit(const Samples& samples) const {
    return {basis_, solver_.solve(assemble(samples))};
  }

  /// The least-squares problem that `fit` solves.
  template <sample_range Samples>
  [[nodiscard]] least_squares_problem assemble(const Samples& samples) const {
    require_usable(samples);
    const auto count = static_cast<Eigen::Index>(std::ranges::distance(samples));
    row_matrix rows(count, static_cast<Eigen::Index>(basis_.size()));
    Eigen::MatrixXd mapped(count, 3);
    Eigen::VectorXd weights(count);
    Eigen::Index i = 0;
    for (const sample& s : samples) {
      const location at = locate(basis_.cells(), s.angles);
      rows.row(i) = row_at(basis_, at);
      const double offset = offset_at(basis_, at);
      for (Eigen::Index channel = 0; channel < 3; ++channel)
        mapped(i, channel) = basis_.metric().forward(s.value[channel], at) - offset;
      weights[i] = s.weight;
      ++i;
    }
    return {std::move(rows), std::move(mapped), std::move(weights)};
  }

 private:
  Basis basis_;
  Solver solver_;
};

}  // namespace gonio
