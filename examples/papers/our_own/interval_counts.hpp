#pragma once
/// How often the intervals of a reconstruction contain the true values.

#include "tool/files/json.hpp"
#include <gonio/estimate/reconstruction.hpp>

#include <string>
#include <vector>

namespace papers {

/// Counts the values of the truth that are within their intervals, in eight regions split by theta_h (2, 10 and 30
/// degrees) and theta_d (45 degrees).
class interval_counts {
 public:
  using reconstructed_type = gonio::reconstruction<gonio::log_relative>::result_type;

  interval_counts() = default;
  explicit interval_counts(const cli::json& counts);
  [[nodiscard]] cli::json to_json() const;

  /// Counts the three channels of a cell, whose intervals of 68 and 95 % are given.
  void add(const gonio::location& at, const gonio::rgb& truth, const gonio::reflectance_interval& of_68,
           const gonio::reflectance_interval& of_95);
  void add(const interval_counts& others);

  /// Returns "68.0 | 95.1 (90.2)": percentages within the 68 and 95 % intervals, and the latter in the worst region.
  [[nodiscard]] std::string text() const;

 private:
  std::vector<double> values_ = std::vector<double>(8, 0.0), within_68_ = values_, within_95_ = values_;
};

/// Returns every 37th cell whose theta_h is at least the smallest: enough to judge uncertainty, which is smooth.
[[nodiscard]] std::vector<Eigen::Index> judged_cells(const gonio::valid_cells& cells, double smallest_theta_h = 0.0);

/// Counts at the judged cells. `table` holds the estimates.
[[nodiscard]] interval_counts count_within(const interval_counts::reconstructed_type& known,
                                           const gonio::brdf_table& table, const gonio::brdf_table& truth,
                                           double smallest_theta_h = 0.0);

}  // namespace papers
