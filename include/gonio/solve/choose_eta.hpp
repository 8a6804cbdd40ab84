#pragma once
/// The penalty of a Tikhonov solver, chosen by how well each observation is predicted from the others.
/// Leave-one-out (PRESS): Allen, Technometrics 16, 1974 (doi:10.1080/00401706.1974.10489157). Generalised
/// cross-validation: Golub, Heath and Wahba, Technometrics 21, 1979 (doi:10.1080/00401706.1979.10489751). Both take the
/// rows' errors for independent and fail where they go together, as those of an image's pixels do if light or camera
/// are off their places (docs/results/directions.md, docs/results/eta.md).

#include <gonio/solve/tikhonov.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace gonio {

/// Which penalties are plausible: 0 <= lowest <= highest, which is not 0.
struct eta_range {
  double lowest = 0.0;
  double highest = std::numeric_limits<double>::infinity();
};

/// What a choice of eta minimises. With the residual r = W^(1/2) (A x - b) at eta, the leverages
/// h_i = w_i a_i (A'WA + eta I)^-1 a_i', and all sums over the n rows of positive weight:
enum class eta_criterion {
  generalised_cross_validation,  ///< n sum r_i^2 / (n - sum h_i)^2: leave-one-out with the leverages' mean for each
  leave_one_out,  ///< sum (r_i / (1 - h_i))^2: the weighted squared error of each row predicted from all others
};

/// `count` numbers from `first` to `last` with equal ratios.
[[nodiscard]] Eigen::VectorXd geometric_sequence(double first, double last, Eigen::Index count);

namespace detail {

/// Where the least score is; of those that are equal but for rounding, the last.
[[nodiscard]] Eigen::Index last_least(const Eigen::VectorXd& scores);

/// Where a function of many eta has its least value: of eight a decade from first to last, then of 31 between the
/// neighbours of the best.
template <class Scores>
[[nodiscard]] double eta_of_least(const Scores& scores, double first, double last) {
  const auto steps = std::max<Eigen::Index>(std::llround(8.0 * std::log10(last / first)), 1);
  const Eigen::VectorXd coarse = geometric_sequence(first, last, steps + 1);
  const Eigen::Index best = last_least(scores(coarse));
  const Eigen::VectorXd fine = geometric_sequence(coarse[std::max<Eigen::Index>(best - 1, 0)],
                                                  coarse[std::min<Eigen::Index>(best + 1, steps)], 31);
  return fine[last_least(scores(fine))];
}

/// Scores of one eta for several problems: their sum. `largest` of each is the largest eigenvalue of its A'WA.
template <class Scores>
struct summed_scores {
  std::vector<Scores> parts;

  [[nodiscard]] double largest() const {
    double most = 0.0;
    for (const Scores& each : parts) most = std::max(most, each.largest());
    return most;
  }
  [[nodiscard]] Eigen::VectorXd operator()(const Eigen::VectorXd& etas) const {
    Eigen::VectorXd sum = parts.front()(etas);
    for (Eigen::Index i = 1; i < std::ssize(parts); ++i) sum += parts[i](etas);
    return sum;
  }
};

void require_etas(const eta_range& range);

}  // namespace detail

/// The criterion at each eta, summed over all right-hand sides, in the squared units of W^(1/2) b. Throws gonio::error
/// unless every eta is positive and finite, and as `choose_eta` does, whose complexity it has.
[[nodiscard]] Eigen::VectorXd cross_validate(const least_squares_problem& problem, eta_criterion criterion,
                                             const Eigen::VectorXd& etas);

/// The eta of `tikhonov` that minimises a criterion, one for all right-hand sides together.
///
/// Eight candidates a decade, from 1e-10 of the largest eigenvalue of A'WA, below which rounding decides, to a hundred
/// times that eigenvalue; then 31 between the neighbours of the best. Of equal scores the largest eta wins: where
/// nothing speaks for a smaller one, x stays near 0. A choice at the lower end means that no penalty is needed, one at
/// the upper end that the rows do not predict each other. With few rows that happens by chance: whoever knows more
/// says which etas are plausible, and the choice is among these (`plausible_etas` asks a prior).
///
/// Only rows of positive weight are observations. With fewer than two observations, returns `plausible.highest` if
/// finite; otherwise throws. Throws gonio::error also if all observations are zero, if one is not finite, and for an
/// impossible range.
///
/// n x n dual: O(n^2 k + n^3). Tall: O(n k^2 + k^3), and leave-one-out reads the rows twice for O(n k (k + E r)) with
/// the number of candidates E.
[[nodiscard]] double choose_eta(const least_squares_problem& problem, eta_criterion criterion,
                                const eta_range& plausible = {});

/// The same for several problems whose eta is one: the sum of their criteria is minimised. Problems with less than two
/// observations say nothing, if others do.
[[nodiscard]] double choose_eta(std::span<const least_squares_problem> problems, eta_criterion criterion,
                                const eta_range& plausible = {});

/// `tikhonov` with the eta that `choose_eta` chooses for each problem. It needs the rows: normal equations alone do not
/// tell observations apart. The penalty in the objective and in the KKT residual is that of the chosen eta.
class automatic_tikhonov {
 public:
  /// Throws gonio::error for an impossible range.
  explicit automatic_tikhonov(eta_criterion criterion = eta_criterion::generalised_cross_validation,
                              const eta_range& plausible = {})
      : criterion_(criterion), plausible_(plausible) {
    detail::require_etas(plausible);
  }

  [[nodiscard]] eta_criterion criterion() const noexcept { return criterion_; }
  [[nodiscard]] const eta_range& plausible() const noexcept { return plausible_; }

  /// Throws gonio::error as `choose_eta` does.
  [[nodiscard]] solution solve(const least_squares_problem& problem) const {
    return tikhonov(choose_eta(problem, criterion_, plausible_)).solve(problem);
  }

 private:
  eta_criterion criterion_;
  eta_range plausible_;
};

static_assert(solver<automatic_tikhonov> && !normal_solver<automatic_tikhonov>);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/choose_eta.ipp>
#endif
