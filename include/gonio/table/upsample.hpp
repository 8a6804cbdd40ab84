#pragma once
/// Interpolates fields over the cells of one grid to all cells of another, a row at a time: what `locate` and
/// `interpolate` give cell by cell, up to float rounding, at a few operations a value. Trilinear interpolation
/// is a product of three linear ones, so the two polar axes are blended once for a whole row of phi_d.

#include <gonio/core/parallel.hpp>
#include <gonio/table/location.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <vector>

namespace gonio {

/// Several fields over the cells of a grid: one row for each field, one column for each cell.
template <int Fields>
using cell_fields = Eigen::Array<float, Fields, Eigen::Dynamic>;

/// The valid cells of a grid with one theta_h and theta_d: consecutive numbers, increasing phi_d.
struct cell_row {
  Eigen::Index first = 0;      ///< number of the first cell
  Eigen::Index count = 0;      ///< number of cells, at least 1
  double theta_h = 0.0;        ///< radians
  double theta_d = 0.0;        ///< radians
  const int* phi_d = nullptr;  ///< index along phi_d of each cell
  /// cos theta_i and cos theta_o are sum -+ difference cos phi_d, as in `cosines`.
  double sum = 0.0, difference = 0.0;
  const double* cos_phi_d = nullptr;  ///< by index along phi_d

  /// The cosines of the i-th cell of the row.
  [[nodiscard]] cosine_pair cosine(Eigen::Index i) const noexcept {
    const double part = difference * cos_phi_d[phi_d[i]];
    return {sum - part, sum + part};
  }
};

/// Calls `use(row, values)` for every row of the target's cells, concurrently and in any order; `values` is a
/// Fields x count array of the fields there, for the callee to write over. Reading and blending costs O(target cells x
/// Fields).
template <int Fields, class Use>
void upsample(const valid_cells& from, const cell_fields<Fields>& fields, const valid_cells& to, Use&& use,
              thread_count threads = {}) {
  const grid& source = from.grid();
  const grid& target = to.grid();
  const grid_extents coarse = source.extents(), fine = target.extents();

  // Extend the fields to all cells of the source, so that blending needs no case for the horizon.
  cell_fields<Fields> dense(Fields, source.size());
  for (Eigen::Index linear = 0; linear < source.size(); ++linear)
    std::copy_n(fields.data() + Fields * from.representative(linear), Fields, dense.data() + Fields * linear);

  // Find the interval of the source, and the cosine, of each phi_d of the target.
  std::vector<detail::axis_interval> along_phi(fine.phi_d);
  std::vector<double> cos_phi_d(fine.phi_d);
  for (int k = 0; k < fine.phi_d; ++k) {
    along_phi[k] = detail::periodic_interval(source.phi_d_coordinate(target.phi_d(k)), coarse.phi_d);
    cos_phi_d[k] = std::cos(target.phi_d(k));
  }

  // Visit the target's rows in parallel.
  const Eigen::Index rows = Eigen::Index{fine.theta_h} * fine.theta_d;
  for_each_block(
      rows, fine.theta_d,
      [&](block range) {
        cell_fields<Fields> line(Fields, coarse.phi_d), values(Fields, fine.phi_d);
        std::vector<int> phi_d(fine.phi_d);
        for (Eigen::Index r = range.begin; r < range.end; ++r) {
          const Eigen::Index count = to.row_begin(r + 1) - to.row_begin(r);
          if (count == 0) continue;
          const double theta_h = target.theta_h(static_cast<double>(r / fine.theta_d));
          const double theta_d = target.theta_d(static_cast<double>(r % fine.theta_d));
          // Blend the source's rows around (theta_h, theta_d) into one line over phi_d.
          const auto h = detail::clamped_interval(source.theta_h_coordinate(theta_h), coarse.theta_h);
          const auto d = detail::clamped_interval(source.theta_d_coordinate(theta_d), coarse.theta_d);
          std::fill_n(line.data(), line.size(), 0.0f);
          for (Eigen::Index a = 0; a < 2; ++a)
            for (Eigen::Index b = 0; b < 2; ++b) {
              const auto weight = static_cast<float>(h.weight[a] * d.weight[b]);
              const Eigen::Index start = source.linear({h.node[a], d.node[b], 0});
              if (weight != 0.0f) line += weight * dense.middleCols(start, coarse.phi_d);
            }
          // Interpolate along it at the row's cells.
          const Eigen::Index first = to.row_begin(r), before = r * fine.phi_d;
          for (Eigen::Index i = 0; i < count; ++i) {
            const Eigen::Index k = to.linear(first + i) - before;
            phi_d[i] = static_cast<int>(k);
            const detail::axis_interval& p = along_phi[k];
            values.col(i) = static_cast<float>(p.weight[0]) * line.col(p.node[0]) +
                            static_cast<float>(p.weight[1]) * line.col(p.node[1]);
          }
          // Hand the row to the caller.
          auto row_values = values.leftCols(count);
          const cell_row row{first,
                             count,
                             theta_h,
                             theta_d,
                             phi_d.data(),
                             std::cos(theta_h) * std::cos(theta_d),
                             std::sin(theta_h) * std::sin(theta_d),
                             cos_phi_d.data()};
          use(row, row_values);
        }
      },
      threads);
}

}  // namespace gonio
