#pragma once
/// A fit by components and discrepancy together with what is known about it.

#include <gonio/estimate/discrepancy_decomposition.hpp>
#include <gonio/estimate/posterior.hpp>
#include <gonio/estimate/screened_samples.hpp>

#include <array>
#include <string>
#include <vector>

namespace python {

/// A sample that the others contradict, by its row.
struct disagreement {
  Eigen::Index row = 0;
  std::array<double, 3> measured{}, others_say{};
  double deviation = 0.0, probability = 0.0;

  [[nodiscard]] std::string sentence() const;
};

using log_discrepancy = gonio::discrepancy_decomposition<gonio::log_relative>;

class known_brdf {
 public:
  using fit_type = gonio::fitted_brdf<log_discrepancy::basis_type>;

  /// Of samples that were screened; `rows` are those of the samples that count.
  known_brdf(const log_discrepancy& estimator, const gonio::screened_samples& screened,
             const std::vector<Eigen::Index>& rows);

  [[nodiscard]] gonio::rgb operator()(const gonio::direction& wi, const gonio::direction& wo) const noexcept {
    return fit_(wi, wo);
  }
  [[nodiscard]] gonio::brdf_table tabulate(const gonio::valid_cells& cells, gonio::thread_count threads) const {
    return fit_.tabulate(cells, threads);
  }

  [[nodiscard]] const gonio::posterior<gonio::log_relative>& known() const noexcept { return known_; }
  /// Relative to the value, with a probability of 68 %; both directions are above the horizon.
  [[nodiscard]] double known_to(const gonio::direction& wi, const gonio::direction& wo) const;
  [[nodiscard]] double highlight_factor() const { return gonio::highlight_factor(known_, fit_.cells()); }
  [[nodiscard]] const std::vector<Eigen::Index>& left_out() const noexcept { return left_out_; }
  [[nodiscard]] const std::vector<disagreement>& disagreeing() const noexcept { return disagreeing_; }
  [[nodiscard]] double outlier_share() const noexcept { return outlier_share_; }

 private:
  fit_type fit_;
  gonio::posterior<gonio::log_relative> known_;
  std::vector<Eigen::Index> left_out_;
  std::vector<disagreement> disagreeing_;
  double outlier_share_ = 0.0;
};

/// What makes one.
class discrepancy_estimator {
 public:
  /// Throws gonio::error for an impossible model.
  discrepancy_estimator(gonio::log_relative_pca prior, double variance, double noise, bool rejects, unsigned threads);

  [[nodiscard]] known_brdf fit(const gonio::sample_set& samples) const;

 private:
  log_discrepancy estimator_;
  bool rejects_;
  gonio::thread_count threads_;
};

}  // namespace python
