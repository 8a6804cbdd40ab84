#pragma once
/// Corrects an estimate by iterated correction functions while learning which measurements are outliers: Noell, Koehler
/// and Stricker 2014, section 2.4, steps 1 to 5 (Eq. 12-17).

#include <gonio/estimate/located_samples.hpp>
#include <gonio/estimate/outlier_mixture.hpp>
#include <gonio/estimate/values_at.hpp>
#include <gonio/robust/corrected_brdf.hpp>
#include <gonio/robust/outlier_weights.hpp>
#include <gonio/robust/sampled_functions.hpp>

#include <Eigen/Core>

#include <array>
#include <utility>
#include <vector>

namespace gonio {

/// When the iteration ends, and how strongly it prefers no correction.
struct correction_limits {
  int rounds = 10;
  /// Converged if |sigma - 1| is less than this, averaged over the samples.
  double smallest_change = 1e-3;
  /// Penalty on the squared distance of the weights from the weights that correct nothing: 1 for the constant function,
  /// 0 for all other functions. Only used if there is a constant function. Without the penalty, a few samples would
  /// determine the weights of a hundred functions mostly by their noise.
  double inertia = 1.0;
};

namespace detail {

/// Summarises a round, given an entry for each channel of each sample: `inlier_weights`, total `weights`, the `wanted`
/// factor of the estimate (Eq. 12), and the factor `found` by the round.
[[nodiscard]] correction_round describe_round(const channel_values& inlier_weights, const channel_values& weights,
                                              const channel_values& wanted, const channel_values& found,
                                              thread_count threads);

/// Returns the product of all rounds' corrections over the cells, given the weights of the k functions in each round.
/// O(cells k rounds).
[[nodiscard]] brdf_table total_correction(const correction& corrections, const std::vector<Eigen::MatrixXd>& weights,
                                          thread_count threads);

}  // namespace detail

/// The iteration, one round at a time. Reads rows at cells in place. A round costs O(samples k^2) for k functions, and
/// O(samples k) if the inlier weights have not changed since the previous round.
///
/// ```cpp
/// gonio::correction_run run{initial, corrections, gonio::locate_samples(corrections.cells(), samples)};
/// while (!run.converged()) plot(run.step());
/// const auto paint = run.result();
/// ```
template <tabulated_brdf Initial, outlier_weighting Weighting = automatic_weights, normal_solver Solver = nnls>
class correction_run {
 public:
  /// `samples` must be located on the corrections' cells.
  correction_run(Initial initial, correction corrections, const located_samples& samples, Weighting weighting = {},
                 Solver solver = {}, const correction_limits& limits = {}, thread_count threads = {})
      : initial_(std::move(initial)),
        corrections_(std::move(corrections)),
        weighting_(std::move(weighting)),
        solver_(std::move(solver)),
        limits_(limits),
        threads_(threads),
        locations_(samples.locations),
        functions_(corrections_, samples.locations, threads),
        measured_(samples.channels()),
        confidence_(samples.channel_weights()),
        started_(values_at(initial_, corrections_.cells(), samples.locations, threads)),
        total_(channel_values::Ones(3, measured_.cols())) {}

  /// Return the measurements, and their current estimates.
  [[nodiscard]] const channel_values& measured() const noexcept { return measured_; }
  [[nodiscard]] channel_values estimated() const { return factor().correct(started_, total_); }

  /// Return the current inlier weight of each measurement (Eq. 13), and the factor that its estimate needs (Eq. 12).
  [[nodiscard]] channel_values inlier_weights() const { return weighting_.weigh(measured_, estimated()); }
  [[nodiscard]] channel_values sigma() const { return factor().quotient(measured_, estimated()); }

  /// Makes one round with the current `inlier_weights()`.
  correction_round step() { return step(inlier_weights()); }

  /// Makes one round with given inlier weights. If they have not changed since the previous round, only the right-hand
  /// sides of the normal equations are computed again (Eq. 9-10 with Eq. 16).
  correction_round step(const channel_values& inlier_weights) {
    const channel_values wanted = sigma(), weights = inlier_weights * confidence_;
    if (weights.cols() != gram_weights_.cols() || (weights != gram_weights_).any())
      assemble(weights, wanted);
    else
      rhs_ = functions_.rhs(weights, wanted);
    Eigen::MatrixXd beta(functions_.unknowns(), 3);
    for (Eigen::Index c = 0; c < 3; ++c) beta.col(c) = solve(c);
    const channel_values found = functions_.apply(beta);
    total_ = (total_ * found).min(correction_factor::largest_factor);
    weights_.push_back(std::move(beta));
    history_.push_back(detail::describe_round(inlier_weights, weights, wanted, found, threads_));
    return history_.back();
  }

  /// Returns true if the latest round changed the estimates by less than `smallest_change` on average, or if `rounds`
  /// rounds have been made.
  [[nodiscard]] bool converged() const noexcept {
    if (history_.empty()) return limits_.rounds <= 0;
    return std::ssize(history_) >= limits_.rounds || history_.back().change < limits_.smallest_change;
  }

  [[nodiscard]] const std::vector<correction_round>& history() const noexcept { return history_; }

  /// Returns the current estimate of another run at the samples of this run.
  [[nodiscard]] channel_values estimated_by(const correction_run& other) const {
    const channel_values started = values_at(other.initial_, corrections_.cells(), locations_, threads_);
    channel_values total = channel_values::Ones(3, started.cols());
    for (const Eigen::MatrixXd& beta : other.weights_)
      total = (total * functions_.apply(beta)).min(correction_factor::largest_factor);
    return factor().correct(started, total);
  }

  /// Returns the estimate after the rounds so far. O(cells rounds k) for k functions.
  [[nodiscard]] corrected_brdf<Initial> result() const {
    return {initial_, detail::total_correction(corrections_, weights_, threads_), factor(), weights_, history_};
  }

 private:
  [[nodiscard]] const correction_factor& factor() const noexcept { return corrections_.rule().factor; }

  void assemble(const channel_values& weights, const channel_values& sigma) {
    rhs_.resize(functions_.unknowns(), 3);
    for (Eigen::Index c = 0; c < 3; ++c) {
      const normal_equations normal = functions_.normal(c, weights.row(c), sigma.row(c));
      grams_[c] = normal.gram();
      rhs_.col(c) = normal.rhs();
    }
    gram_weights_ = weights;
  }

  [[nodiscard]] Eigen::VectorXd solve(Eigen::Index channel) const {
    Eigen::MatrixXd gram = grams_[channel], rhs = rhs_.col(channel);
    if (corrections_.rule().has_constant) {
      gram.diagonal().array() += limits_.inertia;
      rhs(rhs.rows() - 1, 0) += limits_.inertia;
    }
    const std::vector<Eigen::Index>& columns = functions_.columns();
    const normal_equations normal{std::move(gram), std::move(rhs)};
    return scatter_columns(solver_.solve(normal.subset(columns)), columns, functions_.unknowns()).weights.col(0);
  }

  Initial initial_;
  correction corrections_;
  Weighting weighting_;
  Solver solver_;
  correction_limits limits_;
  thread_count threads_;
  std::vector<location> locations_;
  sampled_functions<correction> functions_;
  channel_values measured_;
  channel_values confidence_;
  channel_values started_, total_;
  channel_values gram_weights_;  // the weights with which `grams_` were built
  std::array<Eigen::MatrixXd, 3> grams_;
  Eigen::MatrixXd rhs_;
  std::vector<Eigen::MatrixXd> weights_;
  std::vector<correction_round> history_;
};

/// An initial estimator whose estimate is corrected until it agrees with the inliers.
///
/// The method as printed in the paper, with gamma = 3:
/// ```cpp
/// const gonio::measured materials{database, gonio::log{}};
/// const gonio::correction corrections{materials, gonio::correction_rule::as_printed()};
/// const auto paint = gonio::correction_iteration{gonio::decomposition{materials, gonio::nnls{}}, corrections,
///                                                gonio::relative_deviation_weights{3.0}}.fit(samples);
/// ```
/// For samples of unknown quality, `robust_reconstruction` chooses everything.
template <estimator Initial, outlier_weighting Weighting = automatic_weights, normal_solver Solver = nnls>
class correction_iteration {
 public:
  correction_iteration(Initial initial, correction corrections, Weighting weighting = {}, Solver solver = {},
                       const correction_limits& limits = {}, thread_count threads = {})
      : initial_(std::move(initial)),
        corrections_(std::move(corrections)),
        weighting_(std::move(weighting)),
        solver_(std::move(solver)),
        limits_(limits),
        threads_(threads) {}

  /// Returns a run that starts from the initial estimate and steps through its corrections. Takes samples, or a table
  /// whose cells are samples. Throws gonio::error for unusable samples, or if a solver gives up.
  template <class Samples>
  [[nodiscard]] auto initialise(const Samples& samples) const {
    const located_samples located = in_colours(locate_samples(corrections_.cells(), samples, threads_));
    return correction_run{initial_.fit(samples), corrections_, located, weighting_, solver_, limits_, threads_};
  }

  /// Corrects until the run has converged. Throws gonio::error for unusable samples, or if a solver gives up.
  template <class Samples>
  [[nodiscard]] auto fit(const Samples& samples) const {
    auto run = initialise(samples);
    while (!run.converged()) run.step();
    return run.result();
  }

 private:
  Initial initial_;
  correction corrections_;
  Weighting weighting_;
  Solver solver_;
  correction_limits limits_;
  thread_count threads_;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/robust/impl/correction_iteration.ipp>
#endif
