#pragma once
/// Bodies of interpolate/pull_push.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/interpolate/completed_table.hpp>
#include <gonio/interpolate/pull_push.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <utility>
#include <vector>

namespace gonio::detail {

GONIO_INLINE double merged_axis::centre(int run) const noexcept {
  const int runs = extent(), turns = run < 0 ? -1 : run / runs;
  const int first = (run - turns * runs) * stride;
  return turns * cells + 0.5 * (first + std::min(first + stride, cells));
}

GONIO_INLINE axis_interval merged_axis::parents(int run, const merged_axis& coarse) const noexcept {
  const int runs = coarse.extent(), parent = run * stride / coarse.stride;
  const double at = centre(run), middle = coarse.centre(parent);
  if (at == middle) return {{parent, parent}, {1.0, 0.0}};
  const int other = at < middle ? parent - 1 : parent + 1;
  if (!coarse.wraps && (other < 0 || other >= runs)) return {{parent, parent}, {1.0, 0.0}};
  const double share = (at - middle) / (coarse.centre(other) - middle);
  return {{parent, (other + runs) % runs}, {1.0 - share, share}};
}

GONIO_INLINE Eigen::Array4f mean_of(const Eigen::Array4d& sums) noexcept {
  const double weight = sums[3];
  if (!(weight > 0.0)) return Eigen::Array4f::Zero();
  Eigen::Array4d mean = sums / weight;
  mean[3] = std::min(weight, 1.0);
  return mean.cast<float>();
}

GONIO_INLINE Eigen::Array4d weighted(const Eigen::Array4f& cell) noexcept {
  Eigen::Array4d product = cell.cast<double>() * double{cell[3]};
  product[3] = cell[3];
  return product;
}

GONIO_INLINE pyramid_level pull(const pyramid_level& fine, thread_count threads) {
  pyramid_level coarse(fine.theta_h.coarser(), fine.theta_d.coarser(), fine.phi_d.coarser());
  const auto children = [](int run, const merged_axis& from, const merged_axis& to) {
    const int ratio = to.stride / from.stride;
    return std::pair{run * ratio, std::min((run + 1) * ratio, from.extent())};
  };
  coarse.for_each(
      [&](int h, int d, int p) {
        const auto [h_begin, h_end] = children(h, fine.theta_h, coarse.theta_h);
        const auto [d_begin, d_end] = children(d, fine.theta_d, coarse.theta_d);
        const auto [p_begin, p_end] = children(p, fine.phi_d, coarse.phi_d);
        Eigen::Array4d sums = Eigen::Array4d::Zero();
        for (int i = h_begin; i < h_end; ++i)
          for (int j = d_begin; j < d_end; ++j)
            for (int k = p_begin; k < p_end; ++k) sums += weighted(fine.cells.col(fine.index(i, j, k)));
        coarse.cells.col(coarse.index(h, d, p)) = mean_of(sums);
      },
      threads);
  return coarse;
}

GONIO_INLINE void push(const pyramid_level& coarse, pyramid_level& fine, thread_count threads) {
  const auto parents = [](const merged_axis& from, const merged_axis& to) {
    std::vector<axis_interval> all;
    for (int run = 0; run < from.extent(); ++run) all.push_back(from.parents(run, to));
    return all;
  };
  const auto along_h = parents(fine.theta_h, coarse.theta_h), along_d = parents(fine.theta_d, coarse.theta_d),
             along_p = parents(fine.phi_d, coarse.phi_d);
  fine.for_each(
      [&](int h, int d, int p) {
        auto cell = fine.cells.col(fine.index(h, d, p));
        const double known = cell[3];
        if (known == 1.0) return;
        const axis_interval &by_h = along_h[h], &by_d = along_d[d], &by_p = along_p[p];
        Eigen::Array4d around = Eigen::Array4d::Zero();
        for (Eigen::Index a = 0; a < 2; ++a)
          for (Eigen::Index b = 0; b < 2; ++b)
            for (Eigen::Index c = 0; c < 2; ++c)
              around += by_h.weight[a] * by_d.weight[b] * by_p.weight[c] *
                        coarse.cells.col(coarse.index(by_h.node[a], by_d.node[b], by_p.node[c])).cast<double>();
        cell = (known * cell.cast<double>() + (1.0 - known) * around).cast<float>();
        cell[3] = 1.0f;
      },
      threads);
}

}  // namespace gonio::detail

namespace gonio {

GONIO_INLINE completed_table pull_push::fit(const brdf_table& table) const {
  splats sums(cells_.grid());
  for (Eigen::Index cell = 0; cell < table.cells().size(); ++cell)
    sums.add({table.cells().angles(cell), table.at(cell), 1.0});
  return complete(sums);
}

GONIO_INLINE void pull_push::splats::add(const sample& s) {
  auto sum = sums_.col(over_.linear(over_.nearest(s.angles())));
  // Use one weight for all channels, because a cell is known in all channels or in none.
  sum.head<3>() += s.weight.mean() * s.value;
  sum[3] += s.weight.mean();
}

GONIO_INLINE detail::pyramid_level pull_push::splats::finest() const {
  const auto [heights, rows, columns] = over_.extents();
  detail::pyramid_level level({heights}, {rows}, {columns, 1, true});
  for (Eigen::Index cell = 0; cell < sums_.cols(); ++cell) level.cells.col(cell) = detail::mean_of(sums_.col(cell));
  return level;
}

GONIO_INLINE completed_table pull_push::complete(const splats& sums) const {
  std::vector<detail::pyramid_level> pyramid{sums.finest()};
  while (pyramid.back().cells.cols() > 1) pyramid.push_back(detail::pull(pyramid.back(), threads_));
  if (!(pyramid.back().cells(3, 0) > 0.0f)) refuse("all samples have weight zero");
  for (Eigen::Index level = pyramid.size() - 1; level > 0; --level)
    detail::push(pyramid[level], pyramid[level - 1], threads_);

  brdf_table table(cells_);
  for (Eigen::Index cell = 0; cell < cells_.size(); ++cell)
    table.set(cell, pyramid.front().cells.col(cells_.linear(cell)).head<3>().cast<double>());
  return completed_table(std::move(table));
}

}  // namespace gonio
