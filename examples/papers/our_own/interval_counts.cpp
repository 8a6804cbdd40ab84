#include "interval_counts.hpp"

#include "tool/pages/fixed.hpp"

#include <algorithm>
#include <functional>
#include <numeric>

namespace papers {

namespace {

std::vector<double> numbers_of(const cli::json& array) {
  std::vector<double> numbers;
  for (const cli::json& element : array.elements()) numbers.push_back(element.number());
  return numbers;
}

void add_each(std::vector<double>& to, const std::vector<double>& more) {
  std::ranges::transform(to, more, to.begin(), std::plus());
}

double sum(const std::vector<double>& numbers) { return std::accumulate(numbers.begin(), numbers.end(), 0.0); }

}  // namespace

interval_counts::interval_counts(const cli::json& counts)
    : values_(numbers_of(counts["values"])),
      within_68_(numbers_of(counts["within_68"])),
      within_95_(numbers_of(counts["within_95"])) {}

cli::json interval_counts::to_json() const {
  return {{"values", values_}, {"within_68", within_68_}, {"within_95", within_95_}};
}

void interval_counts::add(const gonio::location& at, const gonio::rgb& truth, const gonio::reflectance_interval& of_68,
                          const gonio::reflectance_interval& of_95) {
  const double theta_h = gonio::degrees(at.angles.theta_h);
  const auto region = 2 * (theta_h < 2.0    ? 0
                           : theta_h < 10.0 ? 1
                           : theta_h < 30.0 ? 2
                                            : 3) +
                      (gonio::degrees(at.angles.theta_d) < 45.0 ? 0 : 1);
  const auto holds = [&](const gonio::reflectance_interval& interval) {
    return static_cast<double>((truth >= interval.low && truth <= interval.high).count());
  };
  values_[region] += 3.0;
  within_68_[region] += holds(of_68);
  within_95_[region] += holds(of_95);
}

void interval_counts::add(const interval_counts& others) {
  add_each(values_, others.values_);
  add_each(within_68_, others.within_68_);
  add_each(within_95_, others.within_95_);
}

std::string interval_counts::text() const {
  if (sum(values_) == 0.0) return "- | -";
  double worst = 1.0;
  for (std::size_t region = 0; region < values_.size(); ++region)
    if (values_[region] > 0.0) worst = std::min(worst, within_95_[region] / values_[region]);
  const auto share = [&](const std::vector<double>& within) {
    return cli::fixed(100.0 * sum(within) / sum(values_), 1);
  };
  return share(within_68_) + " | " + share(within_95_) + " (" + cli::fixed(100.0 * worst, 1) + ")";
}

std::vector<Eigen::Index> judged_cells(const gonio::valid_cells& cells, double smallest_theta_h) {
  std::vector<Eigen::Index> judged;
  for (Eigen::Index cell = 0; cell < cells.size(); cell += 37)
    if (cells.angles(cell).theta_h >= smallest_theta_h) judged.push_back(cell);
  return judged;
}

interval_counts count_within(const interval_counts::reconstructed_type& known, const gonio::brdf_table& table,
                             const gonio::brdf_table& truth, double smallest_theta_h) {
  interval_counts counts;
  const std::vector<Eigen::Index> judged = judged_cells(table.cells(), smallest_theta_h);
  std::vector<gonio::location> locations;
  for (const Eigen::Index cell : judged) locations.push_back(gonio::locate_cell(table.cells(), cell));
  const std::vector<double> half_68 = known.half_widths(locations, gonio::confidence_level::sixty_eight_percent),
                            half_95 = known.half_widths(locations, gonio::confidence_level::ninety_five_percent);
  for (Eigen::Index i = 0; i < std::ssize(judged); ++i) {
    const gonio::rgb estimate = table.at(judged[i]);
    counts.add(locations[i], truth.at(judged[i]).max(0.0), known.interval(estimate, locations[i], half_68[i]),
               known.interval(estimate, locations[i], half_95[i]));
  }
  return counts;
}

}  // namespace papers
