#pragma once
/// Scattered-data interpolation over a pyramid of grids on the table of a BRDF: Gortler, Grzeszczuk, Szeliski and
/// Cohen, "The Lumigraph", SIGGRAPH 1996 (doi:10.1145/237170.237200), section 3.3 (splat, pull, push). Noell, Koehler
/// and Stricker 2014, section 3.1, compare their estimator with it.

#include <gonio/core/parallel.hpp>
#include <gonio/interpolate/completed_table.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <utility>
#include <vector>

namespace gonio {

namespace detail {

/// An axis of `cells` cells, merged into runs of `stride` cells, starting with the first. The last run may be shorter.
struct merged_axis {
  int cells = 1;
  int stride = 1;
  bool wraps = false;

  [[nodiscard]] int extent() const noexcept { return (cells + stride - 1) / stride; }

  /// Returns the centre of a run, in cells. On an axis that wraps, `run` may be outside of the axis.
  [[nodiscard]] double centre(int run) const noexcept;

  /// Returns the axis with runs twice as long, unless one run already has all cells.
  [[nodiscard]] merged_axis coarser() const noexcept { return {cells, extent() > 1 ? 2 * stride : stride, wraps}; }

  /// Returns the coarser runs around the centre of a run, with the weights of linear interpolation: 3/4 and 1/4, except
  /// next to a shorter run at the end.
  [[nodiscard]] axis_interval parents(int run, const merged_axis& coarse) const noexcept;
};

/// A level of the pyramid. A column of `cells` has three channels of reflectance and their weight, from 0 to 1.
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
        theta_h.extent(), 1,
        [&](block layer) {
          for (int d = 0; d < theta_d.extent(); ++d)
            for (int p = 0; p < phi_d.extent(); ++p) visit(static_cast<int>(layer.begin), d, p);
        },
        threads);
  }
};

/// Converts sums of weighted values and of weights to mean values and a weight of at most 1.
[[nodiscard]] Eigen::Array4f mean_of(const Eigen::Array4d& sums) noexcept;

/// Returns a cell's value times its weight, and the weight, to be added up.
[[nodiscard]] Eigen::Array4d weighted(const Eigen::Array4f& cell) noexcept;

/// Pull: combines the finer cells into cells of twice their size.
[[nodiscard]] pyramid_level pull(const pyramid_level& fine, thread_count threads);

/// Push: completes each finer cell whose weight is below 1 from the complete coarser cells around it.
void push(const pyramid_level& coarse, pyramid_level& fine, thread_count threads);

}  // namespace detail

/// Completes a table from measurements. Each measurement is assigned to the nearest cell.
///
/// - Splat: a cell has the weighted mean of its measurements and the sum of their weights, at most 1.
/// - Pull: cells of twice the size along each axis have the weighted mean of their parts and the sum of their weights,
///   at most 1. Pulling ends with a single cell.
/// - Push: from the coarsest level down, a cell of weight w gets w times its own value plus 1 - w times the coarser
///   level's value, interpolated linearly between the centres of the coarser cells.
///
/// Extents need not be powers of two. phi_d wraps (reciprocity); theta_h and theta_d do not. A cell measured with a
/// weight of at least 1 keeps its mean exactly, unless it is negative. Negative measurements are averaged like others,
/// so that noise cancels; negative results become zero. Outliers are interpolated like any other value.
///
/// ```cpp
/// const auto paint = gonio::pull_push{gonio::valid_cells()}.fit(samples);
/// ```
class pull_push {
 public:
  explicit pull_push(valid_cells cells, thread_count threads = {}) : cells_(std::move(cells)), threads_(threads) {}

  [[nodiscard]] const valid_cells& cells() const noexcept { return cells_; }

  /// Completes a table. O(samples + cells of the grid), 50 bytes for each cell. Throws gonio::error for unusable
  /// samples (`require_usable`), or if all weights are zero.
  template <sample_range Samples>
  [[nodiscard]] completed_table fit(const Samples& samples) const {
    require_usable(samples);
    splats sums(cells_.grid());
    for (const sample& s : samples) sums.add(s);
    return complete(sums);
  }

  /// Takes the cells of a table as samples of weight 1.
  [[nodiscard]] completed_table fit(const brdf_table& table) const;

 private:
  /// Sums weighted values and weights over the measurements nearest to each cell of a grid.
  class splats {
   public:
    explicit splats(const grid& over) : over_(over), sums_(Eigen::Array4Xd::Zero(4, over.size())) {}

    void add(const sample& s);

    [[nodiscard]] detail::pyramid_level finest() const;

   private:
    grid over_;
    Eigen::Array4Xd sums_;
  };

  [[nodiscard]] completed_table complete(const splats& sums) const;

  valid_cells cells_;
  thread_count threads_;
};

static_assert(estimator<pull_push>);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/interpolate/impl/pull_push.ipp>
#endif
