#pragma once
/// Chooses the penalty of a Tikhonov solver by how well each observation is predicted from all others. Leave-one-out
/// (PRESS): Allen, Technometrics 16, 1974 (doi:10.1080/00401706.1974.10489157). Generalised cross-validation: Golub,
/// Heath and Wahba, Technometrics 21, 1979 (doi:10.1080/00401706.1979.10489751). Both assume independent errors of the
/// rows, and fail for shared errors, such as those of an image's pixels if the stated position of light or camera is
/// wrong (docs/results/directions.md, docs/results/eta.md).

#include <gonio/solve/tikhonov.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace gonio {

/// The range of plausible penalties: 0 <= lowest <= highest, and highest is not 0.
struct eta_range {
  double lowest = 0.0;
  double highest = std::numeric_limits<double>::infinity();
};

/// The criteria for choosing eta. With the residual r = W^(1/2) (A x - b) at eta, the leverages h_i = w_i a_i (A'WA +
/// eta I)^-1 a_i', and sums over the n rows of positive weight:
enum class eta_criterion {
  generalised_cross_validation,  ///< n sum r_i^2 / (n - sum h_i)^2: leave-one-out with the mean leverage for all rows
  leave_one_out,  ///< sum (r_i / (1 - h_i))^2: the weighted squared error of each row predicted from all others
};

/// Returns `count` numbers from `first` to `last` with equal ratios.
[[nodiscard]] Eigen::VectorXd geometric_sequence(double first, double last, Eigen::Index count);

namespace detail {

/// Returns the position of the lowest score. If several scores are the lowest except for rounding, returns the last
/// position.
[[nodiscard]] Eigen::Index last_least(const Eigen::VectorXd& scores);

/// Minimises a function of eta: tries eight etas per decade from first to last, then 31 between the neighbours of the
/// best. `scores` computes the function for many etas at once.
template <class Scores>
[[nodiscard]] double eta_of_least(const Scores& scores, double first, double last) {
  const auto steps = std::max<Eigen::Index>(std::llround(8.0 * std::log10(last / first)), 1);
  const Eigen::VectorXd coarse = geometric_sequence(first, last, steps + 1);
  const Eigen::Index best = last_least(scores(coarse));
  const Eigen::VectorXd fine = geometric_sequence(coarse[std::max<Eigen::Index>(best - 1, 0)],
                                                  coarse[std::min<Eigen::Index>(best + 1, steps)], 31);
  return fine[last_least(scores(fine))];
}

/// The sum of the scores of several problems with the same eta. The `largest()` of a problem is the largest eigenvalue
/// of its A'WA.
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

/// Returns the criterion at each eta, summed over all right-hand sides, in the squared units of W^(1/2) b. Throws
/// gonio::error unless every eta is positive and finite, and as `choose_eta` does. As fast as `choose_eta`.
[[nodiscard]] Eigen::VectorXd cross_validate(const least_squares_problem& problem, eta_criterion criterion,
                                             const Eigen::VectorXd& etas);

/// Returns the eta of `tikhonov` that minimises a criterion for all right-hand sides together.
///
/// Tries eight candidates per decade, from 1e-10 of the largest eigenvalue of A'WA, below which rounding dominates, to
/// 100 times that eigenvalue; then 31 between the neighbours of the best. Among equal scores, chooses the largest eta:
/// x stays near 0 unless the data favour a smaller eta. A choice at the lower end means that no penalty is needed; a
/// choice at the upper end, that the rows do not predict each other. With few rows, such choices happen by chance, so
/// pass a range of `plausible` etas if it is known (`plausible_etas` computes it from a prior).
///
/// Only rows of positive weight are observations. With fewer than two, returns `plausible.highest` if it is finite,
/// otherwise throws. Also throws gonio::error if all observations are zero, if one is not finite, and for an impossible
/// range.
///
/// For n observations of k unknowns: O(n^2 k + n^3) through the n x n dual if n <= k, else O(n k^2 + k^3), and
/// leave-one-out reads the rows twice more, in O(n k (k + E r)) for E candidates and r right-hand sides.
[[nodiscard]] double choose_eta(const least_squares_problem& problem, eta_criterion criterion,
                                const eta_range& plausible = {});

/// Returns the eta that minimises the sum of the criterion over several problems. Ignores problems with fewer than two
/// observations unless all have so few.
[[nodiscard]] double choose_eta(std::span<const least_squares_problem> problems, eta_criterion criterion,
                                const eta_range& plausible = {});

/// `tikhonov` with the eta that `choose_eta` chooses for each problem. Needs the rows of the problem, because normal
/// equations do not distinguish observations. The objective and the KKT residual use the chosen eta.
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
