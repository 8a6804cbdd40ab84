#pragma once
/// Rates from the p-values of many tests: false alarms, detections, the ROC curve.

#include "papers/experiments.hpp"
#include "tool/pages/fixed.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace papers {

/// p-values by kind of test and by material.
class p_values {
 public:
  void add(const std::string& what, const std::string& material, const std::vector<double>& values) {
    std::vector<double>& all = of_[what][material];
    all.insert(all.end(), values.begin(), values.end());
  }

  [[nodiscard]] std::vector<double> all(const std::string& what) const {
    std::vector<double> together;
    for (const auto& [material, values] : of_.at(what)) together.insert(together.end(), values.begin(), values.end());
    return together;
  }

  /// Returns the smallest share of p-values below a level among the materials, and its material.
  [[nodiscard]] std::pair<double, std::string> worst(const std::string& what, double level) const {
    std::pair<double, std::string> least{2.0, ""};
    for (const auto& [material, values] : of_.at(what)) least = std::min(least, {below(values, level), material});
    return least;
  }

  [[nodiscard]] static double below(const std::vector<double>& values, double level) {
    return static_cast<double>(std::ranges::count_if(values, [&](double p) { return p < level; })) /
           static_cast<double>(values.size());
  }

 private:
  std::map<std::string, std::map<std::string, std::vector<double>>> of_;
};

[[nodiscard]] inline std::string percent(double share) { return fixed(100.0 * share, 1); }

/// "0.95 (0.69 to 1.30)": a share in per cent with its 95 % confidence interval, by E. B. Wilson (1927).
[[nodiscard]] inline std::string with_interval(const std::vector<double>& values, double level) {
  constexpr double z = 1.96;
  const auto n = static_cast<double>(values.size());
  const double share = p_values::below(values, level), centre = (share + 0.5 * z * z / n) / (1.0 + z * z / n);
  const double reach = z / (1.0 + z * z / n) * std::sqrt(share * (1.0 - share) / n + 0.25 * z * z / (n * n));
  return fixed(100.0 * share, 2) + " (" + fixed(100.0 * std::max(centre - reach, 0.0), 2) + " to " +
         fixed(100.0 * (centre + reach), 2) + ")";
}

/// Returns the area under the ROC curve: the probability that a differing part has a smaller p-value than a matching
/// one.
[[nodiscard]] inline double area(const std::vector<double>& alike, std::vector<double> different) {
  std::ranges::sort(different);
  double sum = 0.0;
  for (const double p : alike) {
    const auto [low, high] = std::ranges::equal_range(different, p);
    sum += static_cast<double>(low - different.begin()) + 0.5 * static_cast<double>(high - low);
  }
  return sum / static_cast<double>(alike.size()) / static_cast<double>(different.size());
}

}  // namespace papers
