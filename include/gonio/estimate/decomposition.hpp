#pragma once
/// Basis decomposition: mapped measurements as a linear combination of a basis' functions.
/// Nielsen et al. 2015 (doi:10.1145/2816795.2818085), Eq. 9-12 (pca x log-relative x Tikhonov); Noell et al. 2014, Eq.
/// 7-11 (measured x log x NNLS).

#include <gonio/estimate/basis_equations.hpp>
#include <gonio/estimate/decomposition_parts.hpp>
#include <gonio/estimate/estimator.hpp>
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/solve/solver.hpp>

#include <concepts>
#include <utility>

namespace gonio {

/// Non-negative weights make no sense for functions of arbitrary sign. Use `tikhonov`, `least_squares`, `truncated_svd`
/// or `lasso` with principal components, and non-negative solvers with measured materials. The compiler reports the
/// name of this concept if principal components and a non-negative solver are combined.
template <class Basis, class Solver>
concept non_negative_weights_need_functions_of_definite_sign =
    !(has_arbitrary_sign<Basis> && solves_non_negative<Solver>);

/// Fits each channel of measurements by a basis, with weights found by a solver; see `basis_equations`.
///
/// ```cpp
/// const auto paint = gonio::decomposition{prior, gonio::tikhonov{40.0}}.fit(samples);
/// const auto lc = gonio::decomposition{gonio::measured{materials, gonio::log{}}, gonio::nnls{}}.fit(samples);
/// ```
/// Basis must be a `colour_basis`, Solver a `solver`. If one is not, the compiler's first lines name the missing
/// member.
template <class Basis, class Solver>
requires non_negative_weights_need_functions_of_definite_sign<Basis, Solver>
class decomposition {
  static_assert(sizeof(detail::decomposition_parts<Basis, Solver>) > 0);

 public:
  explicit decomposition(Basis basis, Solver solver = Solver(), thread_count threads = {})
      : basis_(std::move(basis)), solver_(std::move(solver)), threads_(threads) {}

  /// Fits samples, or a table whose cells are samples of weight 1. If channels share their basis, there may be any
  /// number of channels: each wavelength is fitted as a grey material, and channels with the same weights share one
  /// factorisation. If each channel has its own basis, the channels must be colours. Costs the solver plus O(samples x
  /// size of the basis) for reading the rows, and O(samples x size^2) more if the solver uses the normal equations.
  /// Throws gonio::error for unusable samples, or if the solver gives up.
  template <class Samples>
  [[nodiscard]] fitted_brdf<Basis> fit(const Samples& samples) const {
    located_samples located = locate_samples(cells(), samples, threads_);
    channels kinds = basis<Basis> ? located.kinds : channels();
    const basis_equations equations(basis_, std::move(located), threads_);
    return {basis_, equations.solve(solver_), std::move(kinds)};
  }

  [[nodiscard]] const auto& cells() const noexcept { return basis_.cells(); }

 private:
  Basis basis_;
  Solver solver_;
  thread_count threads_;
};

}  // namespace gonio
