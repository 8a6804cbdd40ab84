#pragma once
/// Bodies of table/upsample.hpp.

#include <gonio/core/assertion.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/table/upsample.hpp>

#include <Eigen/Core>

#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace gonio::detail {

GONIO_INLINE std::vector<axis_run> axis_runs(std::span<const axis_interval> intervals, Eigen::Index longest) {
  // More than the 1e-9 by which `split_coordinate` moves a coordinate to a node.
  constexpr double rounding = 1e-8;
  std::vector<axis_run> runs;
  double step = 0.0;
  for (std::size_t k = 0; k < intervals.size(); ++k) {
    const axis_interval& here = intervals[k];
    if (k > 0 && runs.back().count < longest && here.node == intervals[k - 1].node) {
      const double grown = here.weight[1] - intervals[k - 1].weight[1];
      if (runs.back().count == 1) step = grown;
      if (grown <= axis_run::largest_step + rounding && std::abs(grown - step) <= rounding) {
        ++runs.back().count;
        runs.back().step = static_cast<float>(step);
        continue;
      }
    }
    runs.push_back({static_cast<Eigen::Index>(k), 1, {here.node[0], here.node[1]}, static_cast<float>(here.weight[1])});
  }
  return runs;
}

GONIO_INLINE grid_runs::grid_runs(const grid& source, const grid& target, Eigen::Index longest) {
  const grid_extents from = source.extents(), to = target.extents();
  std::vector<axis_interval> along;
  for (int h = 0; h < to.theta_h; ++h)
    theta_h.push_back(clamped_interval(source.theta_h_coordinate(target.theta_h(h)), from.theta_h));
  for (int d = 0; d < to.theta_d; ++d)
    along.push_back(clamped_interval(source.theta_d_coordinate(target.theta_d(d)), from.theta_d));
  theta_d = axis_runs(along, longest);
  along.clear();
  for (int k = 0; k < to.phi_d; ++k)
    along.push_back(periodic_interval(source.phi_d_coordinate(target.phi_d(k)), from.phi_d));
  phi_d = axis_runs(along, longest);
}

GONIO_INLINE valid_rows::valid_rows(valid_cells cells) : cells_(std::move(cells)) {
  const grid& over = cells_.grid();
  const auto made = [](double value) { return angle{value, std::cos(value), std::sin(value)}; };
  for (int h = 0; h < over.extents().theta_h; ++h) theta_h_.push_back(made(over.theta_h(h)));
  for (int d = 0; d < over.extents().theta_d; ++d) theta_d_.push_back(made(over.theta_d(d)));
  for (int k = 0; k < over.extents().phi_d; ++k) cos_phi_d_.push_back(std::cos(over.phi_d(k)));
}

GONIO_INLINE cell_row valid_rows::row(Eigen::Index theta_h, Eigen::Index theta_d) const {
  const Eigen::Index row = number(theta_h, theta_d), first = cells_.row_begin(row);
  const Eigen::Index count = cells_.row_begin(row + 1) - first;
  const angle &h = theta_h_[theta_h], &d = theta_d_[theta_d];
  if (count == 0) return {first, 0, h.value, d.value};
  const Eigen::Index first_phi_d = cells_.row_linear(row) - row * std::ssize(cos_phi_d_);
  GONIO_ASSERT(cells_.linear(first + count - 1) == cells_.linear(first) + count - 1);
  return {first, count, h.value, d.value, first_phi_d, h.cosine * d.cosine, h.sine * d.sine, cos_phi_d_.data()};
}

}  // namespace gonio::detail
