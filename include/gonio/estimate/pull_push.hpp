#pragma once
/// Scattered-data interpolation over a pyramid of grids: Gortler, Grzeszczuk, Szeliski and Cohen, "The Lumigraph",
/// SIGGRAPH 1996, section 3.3 (splat, pull, push), which Noell, Koehler and Stricker 2014, section 3.1, compare their
/// estimator with, over the table of a BRDF.

#include <gonio/core/parallel.hpp>
#include <gonio/estimate/completed_table.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace gonio {

namespace detail {

/// The cells of an axis of n, merged in runs of `stride` from the first on; the last run may be shorter.
struct merged_axis {
  int cells = 1;
  int stride = 1;
  bool wraps = false;

  [[nodiscard]] int extent() const noexcept { return (cells + stride - 1) / stride; }

  /// The middle of a run, counted in cells. Beyond the ends of an axis that wraps runs repeat.
  [[nodiscard]] double centre(int run) const noexcept {
    const int runs = extent(), turns = run < 0 ? -1 : run / runs;
    const int first = (run - turns * runs) * stride;
    return turns * cells + 0.5 * (first + std::min(first + stride, cells));
  }

  /// Runs twice as long, unless one holds all cells already.
  [[nodiscard]] merged_axis coarser() const noexcept { return {cells, extent() > 1 ? 2 * stride : stride, wraps}; }

  /// The coarser runs around the centre of a run, with the weights of linear interpolation: 3/4 and 1/4, but for a
  /// shorter run at the end.
  [[nodiscard]] axis_interval parents(int run, const merged_axis& coarse) const noexcept {
    const int runs = coarse.extent(), parent = run * stride / coarse.stride;
    const double at = centre(run), middle = coarse.centre(parent);
    if (at == middle) return {{parent, parent}, {1.0, 0.0}};
    const int other = at < middle ? parent - 1 : parent + 1;
    if (!coarse.wraps && (other < 0 || other >= runs)) return {{parent, parent}, {1.0, 0.0}};
    const double share = (at - middle) / (coarse.centre(other) - middle);
    return {{parent, (other + runs) % runs}, {1.0 - share, share}};
  }
};

/// A level of the pyramid: three channels of reflectance and the weight, at most 1, of what is known about it.
struct pyramid_level {
  merged_axis theta_h, theta_d, phi_d;
  Eigen::Array4Xf cells;

  pyramid_level(const merged_axis& h, const merged_axis& d, const merged_axis& p)
      : theta_h(h), theta_d(d), phi_d(p), cells(4, Eigen::Index{h.extent()} * d.extent() * p.extent()) {}

  [[nodiscard]] Eigen::Index index(int h, int d, int p) const noexcept {
    return (Eigen::Index{h} * theta_d.extent() + d) * phi_d.extent() + p;
  }

  /// Calls `visit(h, d, p)` for all cells, concurrently.
  template <class Visit>
  void for_each(Visit&& visit, thread_count threads) const {
    for_each_block(
        static_cast<std::size_t>(theta_h.extent()), 1,
        [&](block layer) {
          for (int d = 0; d < theta_d.extent(); ++d)
            for (int p = 0; p < phi_d.extent(); ++p) visit(static_cast<int>(layer.begin), d, p);
        },
        threads);
  }
};

/// Sums of weighted values and of weights as mean values and weights that saturate at 1.
[[nodiscard]] inline Eigen::Array4f mean_of(const Eigen::Array4d& sums) noexcept {
  const double weight = sums[3];
  if (!(weight > 0.0)) return Eigen::Array4f::Zero();
  Eigen::Array4d mean = sums / weight;
  mean[3] = std::min(weight, 1.0);
  return mean.cast<float>();
}

/// Value times weight and weight, to be summed.
[[nodiscard]] inline Eigen::Array4d weighted(const Eigen::Array4f& cell) noexcept {
  Eigen::Array4d product = cell.cast<double>() * double{cell[3]};
  product[3] = cell[3];
  return product;
}

/// Pull: what the finer cells know together about each cell of twice their size.
[[nodiscard]] inline pyramid_level pull(const pyramid_level& fine, thread_count threads) {
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

/// Push: as much of each finer cell as is not known comes from the coarser ones around it, which are complete.
inline void push(const pyramid_level& coarse, pyramid_level& fine, thread_count threads) {
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
        const axis_interval &by_h = along_h[static_cast<std::size_t>(h)], &by_d = along_d[static_cast<std::size_t>(d)],
                            &by_p = along_p[static_cast<std::size_t>(p)];
        Eigen::Array4d around = Eigen::Array4d::Zero();
        for (std::size_t a = 0; a < 2; ++a)
          for (std::size_t b = 0; b < 2; ++b)
            for (std::size_t c = 0; c < 2; ++c)
              around += by_h.weight[a] * by_d.weight[b] * by_p.weight[c] *
                        coarse.cells.col(coarse.index(by_h.node[a], by_d.node[b], by_p.node[c])).cast<double>();
        cell = (known * cell.cast<double>() + (1.0 - known) * around).cast<float>();
        cell[3] = 1.0f;
      },
      threads);
}

}  // namespace detail

/// Completes a table from measurements, each of which counts for the cell nearest to it.
///
/// - Splat: a cell has the weighted mean of its measurements, and the sum of their weights, at most 1, as its own.
/// - Pull: cells of twice the size along each axis have the weighted mean and, at most 1, the summed weight of their
///   parts, up to a single cell.
/// - Push: from the coarsest level down, a cell of weight w keeps w of its own value and takes 1 - w from the coarser
///   level, interpolated linearly between the centres of its cells.
///
/// Extents need not be powers of two: phi_d wraps for any (reciprocity), theta_h and theta_d end. A cell measured with
/// a weight of at least 1 keeps its mean exactly, unless that is negative: measurements are averaged as they are, so
/// that noise cancels, and what is negative in the end becomes zero. Outliers are interpolated like anything else.
///
/// ```cpp
/// const auto paint = gonio::pull_push{gonio::valid_cells()}.fit(samples);
/// ```
class pull_push {
 public:
  /// Completes tables over these cells.
  explicit pull_push(valid_cells cells, thread_count threads = {}) : cells_(std::move(cells)), threads_(threads) {}

  [[nodiscard]] const valid_cells& cells() const noexcept { return cells_; }

  /// O(samples + cells of the grid), 50 bytes for each of these. Throws gonio::error for unusable samples
  /// (`require_usable`), or if all weights are zero.
  template <sample_range Samples>
  [[nodiscard]] completed_table fit(const Samples& samples) const {
    require_usable(samples);
    splats sums(cells_.grid());
    for (const sample& s : samples) sums.add(s);
    return complete(sums);
  }

  /// Each cell of a table is a sample of weight 1.
  [[nodiscard]] completed_table fit(const brdf_table& table) const {
    splats sums(cells_.grid());
    for (std::size_t cell = 0; cell < table.cells().size(); ++cell)
      sums.add({table.cells().angles(cell), table.at(cell), 1.0});
    return complete(sums);
  }

 private:
  /// Sums of weighted values, and of weights, over the measurements nearest to each cell of a grid.
  class splats {
   public:
    explicit splats(const grid& over)
        : over_(over), sums_(Eigen::Array4Xd::Zero(4, static_cast<Eigen::Index>(over.size()))) {}

    void add(const sample& s) {
      auto sum = sums_.col(static_cast<Eigen::Index>(over_.linear(over_.nearest(s.angles))));
      sum.head<3>() += s.weight * s.value;
      sum[3] += s.weight;
    }

    [[nodiscard]] detail::pyramid_level finest() const {
      const auto [heights, rows, columns] = over_.extents();
      detail::pyramid_level level({heights}, {rows}, {columns, 1, true});
      for (Eigen::Index cell = 0; cell < sums_.cols(); ++cell) level.cells.col(cell) = detail::mean_of(sums_.col(cell));
      return level;
    }

   private:
    grid over_;
    Eigen::Array4Xd sums_;
  };

  [[nodiscard]] completed_table complete(const splats& sums) const {
    std::vector<detail::pyramid_level> pyramid{sums.finest()};
    while (pyramid.back().cells.cols() > 1) pyramid.push_back(detail::pull(pyramid.back(), threads_));
    if (!(pyramid.back().cells(3, 0) > 0.0f)) throw error("all samples have weight zero: nothing is known");
    for (std::size_t level = pyramid.size() - 1; level > 0; --level)
      detail::push(pyramid[level], pyramid[level - 1], threads_);

    brdf_table table(cells_);
    for (std::size_t cell = 0; cell < cells_.size(); ++cell)
      table.set(cell,
                pyramid.front().cells.col(static_cast<Eigen::Index>(cells_.linear(cell))).head<3>().cast<double>());
    return completed_table(std::move(table));
  }

  valid_cells cells_;
  thread_count threads_;
};

static_assert(estimator<pull_push>);

}  // namespace gonio
