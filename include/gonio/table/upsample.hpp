#pragma once
/// Interpolates fields over the cells of one grid to all cells of another, a row at a time: what `locate` and
/// `interpolate` give cell by cell, up to float rounding, at a few operations a value. Trilinear interpolation
/// is a product of three linear ones, so the two polar axes are blended once for a whole row of phi_d.

#include <gonio/core/assertion.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/table/location.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace gonio {

/// Several fields over the cells of a grid: one row for each field, one column for each cell.
template <int Fields>
using cell_fields = Eigen::Array<float, Fields, Eigen::Dynamic>;

/// The valid cells of a grid with one theta_h and theta_d: neighbours along phi_d, because both cosines depend on
/// |cos phi_d| alone, numbered one after the other.
struct cell_row {
  Eigen::Index first = 0;        ///< number of the first cell
  Eigen::Index count = 0;        ///< number of cells, at least 1
  double theta_h = 0.0;          ///< radians
  double theta_d = 0.0;          ///< radians
  Eigen::Index first_phi_d = 0;  ///< index along phi_d of the first cell
  /// cos theta_i and cos theta_o are sum -+ difference cos phi_d, as in `cosines`.
  double sum = 0.0, difference = 0.0;
  const double* cos_phi_d = nullptr;  ///< by index along phi_d

  /// The cosines of the i-th cell of the row.
  [[nodiscard]] cosine_pair cosine(Eigen::Index i) const noexcept {
    const double part = difference * cos_phi_d[first_phi_d + i];
    return {sum - part, sum + part};
  }
};

namespace detail {

/// The fields at all cells of a grid, so that blending needs no case for the horizon.
template <int Fields>
[[nodiscard]] cell_fields<Fields> extended_fields(const valid_cells& from, const cell_fields<Fields>& fields,
                                                  thread_count threads) {
  const Eigen::Index size = from.grid().size();
  cell_fields<Fields> dense(Fields, size);
  for_each_index(
      size, 16384,
      [&](Eigen::Index linear) {
        std::copy_n(fields.data() + Fields * from.representative(linear), Fields, dense.data() + Fields * linear);
      },
      threads);
  return dense;
}

/// Where the nodes of a grid along phi_d are on the axis of another, and their cosines.
struct phi_d_nodes {
  phi_d_nodes(const grid& source, const grid& target) {
    for (int k = 0; k < target.extents().phi_d; ++k) {
      const axis_interval at = periodic_interval(source.phi_d_coordinate(target.phi_d(k)), source.extents().phi_d);
      along.push_back({at.node[0], at.node[1], static_cast<float>(at.weight[0]), static_cast<float>(at.weight[1])});
      cosine.push_back(std::cos(target.phi_d(k)));
    }
  }

  struct interval {
    Eigen::Index before, after;
    float share_before, share_after;
  };

  std::vector<interval> along;
  std::vector<double> cosine;
};

/// Blends a grid's rows around (theta_h, theta_d) into one line over phi_d.
template <int Fields>
void blend_rows(const grid& source, const cell_fields<Fields>& dense, double theta_h, double theta_d,
                std::span<float> line) {
  const grid_extents extents = source.extents();
  const auto h = clamped_interval(source.theta_h_coordinate(theta_h), extents.theta_h);
  const auto d = clamped_interval(source.theta_d_coordinate(theta_d), extents.theta_d);
  std::ranges::fill(line, 0.0f);
  for (Eigen::Index a = 0; a < 2; ++a)
    for (Eigen::Index b = 0; b < 2; ++b) {
      const auto weight = static_cast<float>(h.weight[a] * d.weight[b]);
      const auto start = source.linear({h.node[a], d.node[b], 0});
      if (weight != 0.0f) add_scaled(weight, dense.data() + Fields * start, line.data(), std::ssize(line));
    }
}

}  // namespace detail

/// Calls `use(row, values)` for every row of the target's cells, concurrently and in any order; `values` is a
/// Fields x count array of the fields there, for the callee to write over. Reading and blending costs O(target cells x
/// Fields).
template <int Fields, class Use>
void upsample(const valid_cells& from, const cell_fields<Fields>& fields, const valid_cells& to, Use&& use,
              thread_count threads = {}) {
  const grid& source = from.grid();
  const grid& target = to.grid();
  const Eigen::Index theta_d_count = target.extents().theta_d, phi_d_count = target.extents().phi_d;
  const cell_fields<Fields> dense = detail::extended_fields<Fields>(from, fields, threads);
  const detail::phi_d_nodes nodes(source, target);

  // Visit the target's rows in parallel.
  for_each_block(
      target.extents().theta_h * theta_d_count, theta_d_count,
      [&](block range) {
        std::vector<float> line(Fields * source.extents().phi_d), values(Fields * phi_d_count);
        for (Eigen::Index r = range.begin; r < range.end; ++r) {
          const auto count = to.row_begin(r + 1) - to.row_begin(r);
          if (count == 0) continue;
          const double theta_h = target.theta_h(static_cast<double>(r / theta_d_count));
          const double theta_d = target.theta_d(static_cast<double>(r % theta_d_count));
          detail::blend_rows<Fields>(source, dense, theta_h, theta_d, line);
          // Interpolate along the line at the row's cells.
          const Eigen::Index first = to.row_begin(r), first_phi_d = to.linear(first) - r * phi_d_count;
          GONIO_ASSERT(to.linear(first + count - 1) == to.linear(first) + count - 1);
          for (Eigen::Index i = 0; i < count; ++i) {
            const auto& p = nodes.along[first_phi_d + i];
            using fields_of_cell = Eigen::Array<float, Fields, 1>;
            const fields_of_cell before = Eigen::Map<const fields_of_cell>(line.data() + Fields * p.before),
                                 after = Eigen::Map<const fields_of_cell>(line.data() + Fields * p.after);
            Eigen::Map<fields_of_cell>(values.data() + Fields * i) = p.share_before * before + p.share_after * after;
          }
          // Hand the row to the caller.
          Eigen::Map<cell_fields<Fields>> row_values(values.data(), Fields, count);
          const cell_row row{first,
                             count,
                             theta_h,
                             theta_d,
                             first_phi_d,
                             std::cos(theta_h) * std::cos(theta_d),
                             std::sin(theta_h) * std::sin(theta_d),
                             nodes.cosine.data()};
          use(row, row_values);
        }
      },
      threads);
}

}  // namespace gonio
