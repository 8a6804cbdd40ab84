#pragma once
/// Interpolates fields over the cells of one grid at all cells of another, a row at a time. The values are those of
/// `locate` and `interpolate` for each cell, up to float rounding, but take only a few operations each. Trilinear
/// interpolation is a product of three linear ones. Along an axis, the interpolated field is an arithmetic progression
/// from node to node, and its exponential is a geometric progression: each value takes a multiplication instead of an
/// exponential.

#include <gonio/core/assertion.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/table/location.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <atomic>
#include <span>
#include <vector>

namespace gonio {

/// Several fields over the cells of a grid: one row for each field, one column for each cell.
template <int Fields>
using cell_fields = Eigen::Array<float, Fields, Eigen::Dynamic>;

/// The value of `upsample` between nodes: the weighted mean of the fields, or the geometric mean of their exponentials,
/// which is the exponential of the interpolated field.
enum class weighted_mean { arithmetic, geometric };

/// The valid cells of a grid with one theta_h and theta_d, numbered consecutively. The cells are adjacent along phi_d,
/// because both cosines depend on |cos phi_d| alone.
struct cell_row {
  Eigen::Index first = 0;        ///< number of the first cell
  Eigen::Index count = 0;        ///< number of cells, at least 1
  double theta_h = 0.0;          ///< radians
  double theta_d = 0.0;          ///< radians
  Eigen::Index first_phi_d = 0;  ///< index along phi_d of the first cell
  /// cos theta_i and cos theta_o are sum -+ difference cos phi_d, as in `cosines`.
  double sum = 0.0, difference = 0.0;
  const double* cos_phi_d = nullptr;  ///< by index along phi_d

  /// Returns the cosines of the i-th cell of the row.
  [[nodiscard]] cosine_pair cosine(Eigen::Index i) const noexcept {
    const double part = difference * cos_phi_d[first_phi_d + i];
    return {sum - part, sum + part};
  }
};

namespace detail {

/// Consecutive, equally spaced nodes on an axis of one grid that lie between the same two nodes of another grid's axis.
/// The values interpolated there form a progression.
struct axis_run {
  /// The largest number of nodes in a run: rounding errors grow along a progression.
  static constexpr Eigen::Index longest = 8;
  /// The largest spacing of a run, in cells of the other grid. With a larger one, a run has too few nodes to be
  /// worthwhile.
  static constexpr double largest_step = 0.5;

  Eigen::Index first = 0, count = 1;
  std::array<Eigen::Index, 2> around{};  ///< the two nodes of the other axis
  float share = 0.0f;                    ///< weight of around[1] at the first node of the run
  float step = 0.0f;                     ///< increase of `share` from node to node
};

/// Divides the nodes of an axis into runs of at most `longest` nodes. `intervals` has the position of each node on the
/// other axis.
[[nodiscard]] std::vector<axis_run> axis_runs(std::span<const axis_interval> intervals, Eigen::Index longest);

/// The axes of a target grid, divided into runs between the nodes of a source grid.
struct grid_runs {
  grid_runs(const grid& source, const grid& target, Eigen::Index longest = axis_run::longest);

  std::vector<axis_interval> theta_h;  ///< without runs: few nodes, not equally spaced in angle
  std::vector<axis_run> theta_d, phi_d;
};

/// The rows of a grid's valid cells.
class valid_rows {
 public:
  explicit valid_rows(valid_cells cells);

  /// Returns a row; its count is zero if no cell of the row is valid.
  [[nodiscard]] cell_row row(Eigen::Index theta_h, Eigen::Index theta_d) const;

  /// Returns true if no cell is valid in a range of rows with the same theta_h.
  [[nodiscard]] bool none(Eigen::Index theta_h, block theta_d) const {
    return cells_.row_begin(number(theta_h, theta_d.begin)) == cells_.row_begin(number(theta_h, theta_d.end));
  }

 private:
  struct angle {
    double value, cosine, sine;
  };

  [[nodiscard]] Eigen::Index number(Eigen::Index theta_h, Eigen::Index theta_d) const {
    return theta_h * std::ssize(theta_d_) + theta_d;
  }

  valid_cells cells_;
  std::vector<angle> theta_h_, theta_d_;
  std::vector<double> cos_phi_d_;
};

/// The largest absolute value of a field whose exponential is computed by geometric progressions. The ratio of
/// successive values along one axis, and the change of this ratio along the other, are then within the range of floats,
/// too.
inline constexpr float largest_logarithm = 43.0f;

/// Fields at all cells of a grid, valid or not: blending needs no special case at the horizon.
template <int Fields>
struct extended_fields {
  cell_fields<Fields> values;
  std::atomic<bool> fit_progressions = true;  ///< no value exceeds `largest_logarithm`

  template <class Read>
  extended_fields(const valid_cells& from, const Read& read, thread_count threads)
      : values(Fields, from.grid().size()) {
    for_each_block(
        values.cols(), 4096,
        [&](block range) {
          for (Eigen::Index linear = range.begin; linear < range.end; ++linear)
            read(from.representative(linear), &values(0, linear));
          const float largest =
              values.middleCols(range.begin, range.size()).abs().template maxCoeff<Eigen::PropagateNaN>();
          if (!(largest <= largest_logarithm)) fit_progressions = false;
        },
        threads);
  }
};

/// The fields of one cell.
template <int Fields>
using fields_of_cell = Eigen::Array<float, Fields, 1>;

/// Blends the source's rows around a theta_h, at the first theta_d of a run, and computes their growth to the next
/// theta_d.
template <int Fields>
void blend_rows(const grid& source, const cell_fields<Fields>& dense, const axis_interval& h, const axis_run& run,
                cell_fields<Fields>& first, cell_fields<Fields>& step) {
  const auto row = [&](Eigen::Index a, Eigen::Index d) {
    return dense.middleCols(source.linear({h.node[a], static_cast<int>(run.around[d]), 0}), first.cols());
  };
  const auto weight = static_cast<float>(h.weight[1]);
  const auto blended = [&](Eigen::Index d) { return row(0, d) + weight * (row(1, d) - row(0, d)); };
  first = blended(0);
  step = blended(1) - first;
  first += run.share * step;
  step *= run.step;
}

/// Interpolates a line over the source's phi_d at every phi_d of the target.
template <int Fields, weighted_mean Mean>
class phi_d_line {
 public:
  explicit phi_d_line(std::span<const axis_run> runs)
      : runs_(runs), progressions_(cell_fields<Fields>::Zero(Fields, (2 * runs.size() + 15) / 16 * 16)) {}

  void interpolate(const cell_fields<Fields>& line, cell_fields<Fields>& out) {
    begin_runs(line);
    for (Eigen::Index r = 0; r < std::ssize(runs_); ++r) {
      const block nodes{runs_[r].first, runs_[r].first + runs_[r].count};
      fields_of_cell<Fields> value = progressions_.col(2 * r);
      const fields_of_cell<Fields> step = progressions_.col(2 * r + 1);
      for (Eigen::Index k = nodes.begin; k < nodes.end; ++k) {
        out.col(k) = value;
        if constexpr (Mean == weighted_mean::geometric)
          value *= step;
        else
          value += step;
      }
    }
  }

 private:
  void begin_runs(const cell_fields<Fields>& line) {
    for (Eigen::Index r = 0; r < std::ssize(runs_); ++r) {
      const axis_run& run = runs_[r];
      const fields_of_cell<Fields> before = line.col(run.around[0]), growth = line.col(run.around[1]) - before;
      progressions_.col(2 * r) = before + run.share * growth;
      progressions_.col(2 * r + 1) = run.step * growth;
    }
    if constexpr (Mean == weighted_mean::geometric) exponentiate(progressions_.data(), progressions_.size());
  }

  std::span<const axis_run> runs_;
  // The first value and the step of each run, padded with zeros to a multiple of sixteen numbers.
  cell_fields<Fields> progressions_;
};

}  // namespace detail

/// Calls `use(row, values)` for every row of the target's cells, concurrently and in any order. `values` (Fields x
/// count) has the means of the fields. `read(cell, out)` writes the fields of a cell of the source. The relative error
/// of a geometric mean is below 4e-7 (5 + |field|); the mean itself is infinite for fields above 88. If a field exceeds
/// 43, every value costs an exponential. O(target cells x Fields).
template <int Fields, weighted_mean Mean, class Read, class Use>
void upsample(const valid_cells& from, Read&& read, const valid_cells& to, Use&& use, thread_count threads = {}) {
  const grid& source = from.grid();
  const grid& target = to.grid();
  const Eigen::Index phi_d_count = target.extents().phi_d;
  const detail::extended_fields<Fields> dense(from, read, threads);
  const bool exponentials_alone = Mean == weighted_mean::geometric && !dense.fit_progressions;
  const detail::grid_runs runs(source, target, exponentials_alone ? 1 : detail::axis_run::longest);
  const detail::valid_rows rows(to);

  for_each_index(
      target.extents().theta_h, 1,
      [&](Eigen::Index h) {
        cell_fields<Fields> first(Fields, source.extents().phi_d), step(Fields, first.cols());
        cell_fields<Fields> line(Fields, phi_d_count), growth(Fields, phi_d_count);
        detail::phi_d_line<Fields, Mean> along_phi_d(runs.phi_d);
        for (const detail::axis_run& run : runs.theta_d) {
          const block along_theta_d{run.first, run.first + run.count};
          if (rows.none(h, along_theta_d)) continue;
          detail::blend_rows<Fields>(source, dense.values, runs.theta_h[h], run, first, step);
          along_phi_d.interpolate(first, line);
          if (run.count > 1) along_phi_d.interpolate(step, growth);
          for (Eigen::Index d = along_theta_d.begin; d < along_theta_d.end; ++d) {
            if (const cell_row row = rows.row(h, d); row.count > 0) {
              Eigen::Map<const cell_fields<Fields>> values(line.data() + Fields * row.first_phi_d, Fields, row.count);
              use(row, values);
            }
            if (d + 1 == along_theta_d.end) break;
            if constexpr (Mean == weighted_mean::geometric)
              multiply(growth.data(), line.data(), line.size());
            else
              add_scaled(1.0f, growth.data(), line.data(), line.size());
          }
        }
      },
      threads);
}

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/table/impl/upsample.ipp>
#endif
