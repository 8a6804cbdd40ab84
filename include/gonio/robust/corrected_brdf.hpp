#pragma once
/// An estimate times a correction function: Noell, Koehler and Stricker 2014, Eq. 5 and 17.

#include <gonio/estimate/estimator.hpp>
#include <gonio/robust/correction.hpp>

#include <Eigen/Core>

#include <utility>
#include <vector>

namespace gonio {

/// The effect of one round of the correction iteration.
struct correction_round {
  /// Relative error of the estimate before the round: the weighted root mean square of sigma - 1 over samples and
  /// channels. Here sigma is the factor that would correct the estimate at a sample (Eq. 12).
  double error = 0.0;
  /// Mean of |sigma - 1| at the samples, where sigma is the factor by which the round changes the estimate.
  double change = 0.0;
  /// Fraction of the inlier weights below one half. Each sample has three inlier weights, one for each channel.
  double down_weighted = 0.0;
};

/// An initial estimate and the product of all corrections applied to it, as a table of factors.
template <tabulated_brdf Initial>
class corrected_brdf {
 public:
  corrected_brdf(Initial initial, brdf_table correction, correction_factor factor, std::vector<Eigen::MatrixXd> weights,
                 std::vector<correction_round> history)
      : initial_(std::move(initial)),
        correction_(std::move(correction)),
        factor_(factor),
        weights_(std::move(weights)),
        history_(std::move(history)) {}

  [[nodiscard]] const Initial& initial() const noexcept { return initial_; }
  /// Returns the product of all rounds' corrections, without a unit.
  [[nodiscard]] const brdf_table& correction() const noexcept { return correction_; }
  /// Returns the weights of the correction functions: for each round a matrix, functions x 3 channels.
  [[nodiscard]] const std::vector<Eigen::MatrixXd>& weights() const noexcept { return weights_; }
  [[nodiscard]] const std::vector<correction_round>& history() const noexcept { return history_; }

  /// Returns the reflectance in sr^-1, at least zero; zero below the horizon.
  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept {
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return rgb::Zero();
    const rgb estimate = initial_(wi, wo);
    const rgb sigma = correction_.at(locate(correction_.cells(), to_half_difference(wi, wo)));
    return corrected(estimate, sigma);
  }

  /// Tabulates the corrected estimate. Any number of threads gives the same bytes.
  [[nodiscard]] brdf_table tabulate(const valid_cells& cells, thread_count threads = {}) const {
    brdf_table table = initial_.tabulate(cells, threads);
    const brdf_table sigma = resample(correction_, cells, threads);
    for_each_index(
        cells.size(), 4096, [&](Eigen::Index cell) { table.set(cell, corrected(table.at(cell), sigma.at(cell))); },
        threads);
    return table;
  }

 private:
  [[nodiscard]] rgb corrected(const rgb& estimate, const rgb& sigma) const noexcept {
    const Eigen::Array3f estimated = estimate.cast<float>(), factors = sigma.cast<float>();
    return Eigen::Array3f(factor_.correct(estimated, factors)).cast<double>();
  }

  Initial initial_;
  brdf_table correction_;
  correction_factor factor_;
  std::vector<Eigen::MatrixXd> weights_;
  std::vector<correction_round> history_;
};

}  // namespace gonio
