#pragma once
/// Look-up in the tables of model/adaptive_brdf.hpp.

#include <gonio/core/arc_tangent.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/huge_pages.hpp>
#include <gonio/model/adaptive_brdf.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace gonio::model::detail {

/// Interpolates linearly. `std::lerp` has guarantees that would take more time than the rest of a look-up.
[[nodiscard]] inline double mixed(double from, double to, double share) noexcept { return from + share * (to - from); }

/// Clamps to [0, 1]. Returns 0 for NaN.
[[nodiscard]] inline double within_unit(double number) noexcept { return std::min(std::max(0.0, number), 1.0); }

/// The position of a number between two neighbours in an ascending list.
struct between_neighbours {
  Eigen::Index first = 0;
  double fraction = 0.0;  ///< position in the interval from the first neighbour to the second, from 0 to 1
};

/// Equidistant nodes from 0 to 1.
class unit_nodes {
 public:
  explicit unit_nodes(Eigen::Index count) : last_first_(count - 2), intervals_(static_cast<double>(count - 1)) {}

  /// Returns the interval that contains a coordinate from 0 to 1.
  [[nodiscard]] between_neighbours find(double coordinate) const noexcept {
    const double scaled = coordinate * intervals_;
    const Eigen::Index first = std::min(static_cast<Eigen::Index>(scaled), last_first_);
    return {first, scaled - static_cast<double>(first)};
  }

 private:
  Eigen::Index last_first_;
  double intervals_;
};

/// The polar angles or the azimuths of wi that have tables.
class light_angles {
 public:
  /// Takes angles in radians.
  explicit light_angles(const std::vector<double>& angles) {
    for (std::size_t i = 0; i + 1 < angles.size(); ++i) {
      from_.push_back(angles[i] * (2.0 / std::numbers::pi));
      per_quarter_turn_.push_back(0.5 * std::numbers::pi / (angles[i + 1] - angles[i]));
    }
  }

  /// Returns the interval that contains an angle in quarter turns, by binary search without branches: a processor
  /// cannot predict successive angles.
  [[nodiscard]] between_neighbours find(double quarter_turn) const noexcept {
    const double* first = from_.data();
    for (Eigen::Index left = std::ssize(from_); left > 1;) {
      const Eigen::Index half = left / 2;
      first += half * static_cast<Eigen::Index>(first[half] <= quarter_turn);
      left -= half;
    }
    const Eigen::Index number = first - from_.data();
    return {number, within_unit((quarter_turn - *first) * per_quarter_turn_[number])};
  }

 private:
  std::vector<double> from_;              ///< all angles but the last, in quarter turns
  std::vector<double> per_quarter_turn_;  ///< one over the distance to the next angle
};

/// A point of the unit square.
struct square_point {
  double across = 0.0;  ///< across the rows
  double along = 0.0;   ///< along a row
};

/// Returns the polar angle of a direction in quarter turns. It may have any length but not be below the horizon.
[[nodiscard]] inline double polar_quarter_turn(const direction& w) noexcept {
  const double across = w.x() * w.x() + w.y() * w.y(), up = w.z() * w.z();
  const double squared = std::min(across, up) / std::max(across, up);
  return gonio::detail::quarter_turns(std::sqrt(squared), squared, gonio::detail::is_more(across, up));
}

/// Returns the azimuth of `w` minus the azimuth of `reference`, in turns, plus 1/2, in [0, 1). The normal counts as
/// having the azimuth of the x axis.
[[nodiscard]] inline double relative_turn(const direction& w, const direction& reference) noexcept {
  double along = reference.x() * w.x() + reference.y() * w.y(), beside = reference.x() * w.y() - reference.y() * w.x();
  if (!(std::max(std::abs(along), std::abs(beside)) > 0.0)) {  // if w or reference is the normal
    const auto x_of = [](const direction& v) { return v.x() == 0.0 && v.y() == 0.0 ? 1.0 : v.x(); };
    along = x_of(reference) * x_of(w) + reference.y() * w.y();
    beside = x_of(reference) * w.y() - reference.y() * x_of(w);
  }
  const gonio::detail::azimuth_terms<double> azimuth(along, beside);
  const double quarter =
      gonio::detail::quarter_turns(azimuth.tangent, azimuth.tangent * azimuth.tangent, azimuth.steep);
  const double half = gonio::detail::half_turns(quarter, azimuth.left);
  const double turn = 0.5 * (half + 0.5 + std::copysign(0.5, beside));
  return turn < 1.0 ? turn : 0.0;
}

/// Returns a direction's coordinate along the rows.
[[nodiscard]] inline double polar_coordinate(const direction& w) noexcept {
  return within_unit(std::sqrt(polar_quarter_turn(w)));
}

/// The patch between four nodes that contains a point, and the point's position in it.
struct square_patch {
  Eigen::Index row = 0;
  Eigen::Index corner = 0;  ///< index of the first number of the patch's first node
  square_point inside;
};

/// The nodes of tables of one size. Each node has `Numbers` numbers. Nodes are stored row by row and table by table.
template <int Numbers>
class node_grid {
 public:
  explicit node_grid(const unit_square_tables& tables)
      : rows_(tables.rows),
        columns_(tables.columns),
        row_length_(Numbers * tables.columns),
        table_length_(tables.rows * row_length_) {}

  /// Returns the patch in the first table.
  [[nodiscard]] square_patch find(const square_point& at) const noexcept {
    const auto [row, across] = rows_.find(at.across);
    const auto [column, along] = columns_.find(at.along);
    return {row, row * row_length_ + column * Numbers, {across, along}};
  }

  [[nodiscard]] Eigen::Index row_length() const noexcept { return row_length_; }
  [[nodiscard]] Eigen::Index table_length() const noexcept { return table_length_; }

  /// Returns `Size` numbers, starting at a patch's first node. Each is interpolated between two rows, and between the
  /// table of `light` and the next table. All `Size` numbers are read together, because a vector costs as much as one
  /// number.
  template <int Size, class Number>
  [[nodiscard]] std::array<Number, Size> mixed_rows(const float* numbers, const square_patch& patch,
                                                    const between_neighbours& light) const noexcept {
    const float* low = numbers + light.first * table_length_ + patch.corner;
    const float *high = low + row_length_, *far_low = low + table_length_, *far_high = high + table_length_;
    const double across = patch.inside.across, both = light.fraction * across;
    const auto w_far_high = static_cast<Number>(both), w_far_low = static_cast<Number>(light.fraction - both),
               w_high = static_cast<Number>(across - both),
               w_low = static_cast<Number>((1.0 - across) - (light.fraction - both));
    std::array<Number, Size> sum;
    for (std::size_t k = 0; k < Size; ++k)
      sum[k] = w_low * Number{low[k]} + w_high * Number{high[k]} + w_far_low * Number{far_low[k]} +
               w_far_high * Number{far_high[k]};
    return sum;
  }

 private:
  unit_nodes rows_, columns_;
  Eigen::Index row_length_, table_length_;
};

/// Interpolates a table that another object owns.
class table_lookup {
 public:
  explicit table_lookup(const unit_square_tables& table) : grid_(table), values_(table.values.data()) {}

  [[nodiscard]] double value(const square_point& at) const noexcept {
    const square_patch patch = grid_.find(at);
    const float *low = values_ + patch.corner, *high = low + grid_.row_length();
    const auto [across, along] = patch.inside;
    return mixed(mixed(low[0], high[0], across), mixed(low[1], high[1], across), along);
  }

 private:
  node_grid<1> grid_;
  const float* values_;
};

/// Sums of a table by the trapezoidal rule, in units of its patches.
struct table_sums {
  Eigen::Index columns;
  Eigen::ArrayXd along;   ///< integral of each row up to each column, row by row
  Eigen::ArrayXd across;  ///< integral over all columns up to each row

  table_sums(const float* values, Eigen::Index rows, Eigen::Index columns_)
      : columns(columns_), along(rows * columns_), across(rows) {
    for (Eigen::Index row = 0; row < rows; ++row) {
      const Eigen::Index first = row * columns;
      along[first] = 0.0;
      for (Eigen::Index i = first + 1; i < first + columns; ++i)
        along[i] = along[i - 1] + 0.5 * (double{values[i - 1]} + double{values[i]});
      across[row] = row == 0 ? 0.0 : across[row - 1] + 0.5 * (row_total(row - 1) + row_total(row));
    }
  }

  [[nodiscard]] double row_total(Eigen::Index row) const noexcept { return along[(row + 1) * columns - 1]; }
  [[nodiscard]] double total() const noexcept { return across[across.size() - 1]; }
};

/// Maps half vectors by the cumulative distributions of visible normals. Holds densities and their sums, scaled so that
/// each table integrates to 1.
class visible_lookup {
 public:
  /// Takes the tables of `density`, and also scales them in place to integrals of 1.
  explicit visible_lookup(unit_square_tables& density) : grid_(density), row_sums_per_table_(2 * density.rows) {
    nodes_.reserve(2 * density.values.size());
    row_sums_.reserve(density.tables * row_sums_per_table_);
    const Eigen::Index size = density.rows * density.columns;
    for (Eigen::Index t = 0; t < density.tables; ++t) {
      const Eigen::Map<Eigen::ArrayXf> values(density.values.data() + t * size, size);
      const table_sums sums(values.data(), density.rows, density.columns);
      if (!(sums.total() > 0.0)) refuse({"no normals are visible from the light's direction number ", t});
      append(sums, values);
    }
  }

  [[nodiscard]] square_point position(const square_point& half, const between_neighbours& light) const noexcept {
    const square_patch patch = grid_.find(half);
    return position(half, patch.inside, grid_.mixed_rows<4, double>(nodes_.data(), patch, light),
                    mixed_row_sums(patch.row, light, 0));
  }

  /// Returns the position between the tables of two azimuths of the light. Each azimuth has `angles` tables.
  [[nodiscard]] square_point position(const square_point& half, const between_neighbours& light,
                                      const between_neighbours& azimuth, Eigen::Index angles) const noexcept {
    const square_patch patch = grid_.find(half);
    const Eigen::Index first = azimuth.first * angles, second = first + angles;
    const auto at = [&](Eigen::Index table) {
      return grid_.mixed_rows<4, double>(nodes_.data() + table * grid_.table_length(), patch, light);
    };
    return position(
        half, patch.inside, all_mixed(at(first), at(second), azimuth.fraction),
        all_mixed(mixed_row_sums(patch.row, light, first), mixed_row_sums(patch.row, light, second), azimuth.fraction));
  }

 private:
  using four = std::array<double, 4>;

  /// Returns, interpolated between two tables: a row's integral, the integral of all rows before it, and both for the
  /// next row.
  [[nodiscard]] four mixed_row_sums(Eigen::Index row, const between_neighbours& light,
                                    Eigen::Index first_table) const noexcept {
    const float* near = row_sums_.data() + (first_table + light.first) * row_sums_per_table_ + 2 * row;
    const float* far = near + row_sums_per_table_;
    four sums;
    for (std::size_t k = 0; k < 4; ++k) sums[k] = mixed(near[k], far[k], light.fraction);
    return sums;
  }

  [[nodiscard]] static four all_mixed(const four& from, const four& to, double share) noexcept {
    four sums;
    for (std::size_t k = 0; k < 4; ++k) sums[k] = mixed(from[k], to[k], share);
    return sums;
  }

  [[nodiscard]] static square_point position(const square_point& half, const square_point& inside, const four& node,
                                             const four& row) noexcept {
    const auto [across, along] = inside;
    // Along the row: the integral before the patch, plus the integral in the patch up to the half vector.
    const auto [left, left_before, right, right_before] = node;
    const double part = left_before + along * (left + 0.5 * along * (right - left));
    // Across the rows: the integral before the patch, plus the integral in the patch up to the half vector.
    const auto [low, low_before, high, high_before] = row;
    const double whole = mixed(low, high, across);
    return {within_unit(low_before + across * (low + 0.5 * across * (high - low))),
            whole > 0.0 ? within_unit(part / whole) : half.along};
  }

  /// Appends a table, scaled to an integral of 1, because its sums are interpolated with the sums of the next theta_i.
  void append(const table_sums& sums, Eigen::Map<Eigen::ArrayXf> density) {
    const auto scaled = [whole = sums.total()](double number) { return static_cast<float>(number / whole); };
    for (Eigen::Index i = 0; i < density.size(); ++i) {
      density[i] = scaled(density[i]);
      nodes_.insert(nodes_.end(), {density[i], scaled(sums.along[i])});
    }
    for (Eigen::Index row = 0; row < sums.across.size(); ++row)
      row_sums_.insert(row_sums_.end(), {scaled(sums.row_total(row)), scaled(sums.across[row])});
  }

  node_grid<2> grid_;
  Eigen::Index row_sums_per_table_;
  std::vector<float, huge_page_allocator<float>>
      nodes_;                    ///< for each node: its density, and the integral of its row up to it
  std::vector<float> row_sums_;  ///< for each row: its integral, and the integral of all rows up to it
};

/// Looks up reflectance. Three successive tables have red, green and blue at one theta_i.
class reflectance_lookup {
 public:
  explicit reflectance_lookup(const unit_square_tables& tables) : grid_(tables) {
    const Eigen::Index size = tables.rows * tables.columns;
    values_.reserve(tables.values.size() + read_beyond);
    for (Eigen::Index t = 0; t < tables.tables; t += 3)
      for (Eigen::Index i = 0; i < size; ++i)
        for (Eigen::Index channel = 0; channel < 3; ++channel)
          values_.push_back(tables.values[(t + channel) * size + i]);
    values_.resize(values_.size() + read_beyond);
  }

  /// Returns the interpolated reflectance times a factor. The factor is applied to the weights of the last
  /// interpolation. If it multiplied the results, compilers would fuse one of the two orders of directions with their
  /// sum, and exchanging the directions would change the last digit. Computes in float, like the nodes, with a relative
  /// error of 1e-7.
  [[nodiscard]] rgb value(const square_point& at, const between_neighbours& light, double factor) const noexcept {
    const square_patch patch = grid_.find(at);
    return between_sides(grid_.mixed_rows<8, float>(values_.data(), patch, light), patch.inside.along, factor);
  }

  /// Returns the reflectance interpolated also between the tables of two azimuths of the light. Each azimuth has
  /// `angles` tables.
  [[nodiscard]] rgb value(const square_point& at, const between_neighbours& light, const between_neighbours& azimuth,
                          Eigen::Index angles, double factor) const noexcept {
    const square_patch patch = grid_.find(at);
    const float* first = values_.data() + azimuth.first * angles * grid_.table_length();
    std::array<float, 8> sides = grid_.mixed_rows<8, float>(first, patch, light);
    const auto next = grid_.mixed_rows<8, float>(first + angles * grid_.table_length(), patch, light);
    const auto share = static_cast<float>(azimuth.fraction);
    for (std::size_t k = 0; k < sides.size(); ++k) sides[k] += share * (next[k] - sides[k]);
    return between_sides(sides, patch.inside.along, factor);
  }

 private:
  [[nodiscard]] static rgb between_sides(const std::array<float, 8>& sides, double along, double factor) noexcept {
    const double right = factor * along, left = factor - right;
    return {left * sides[0] + right * sides[3], left * sides[1] + right * sides[4], left * sides[2] + right * sides[5]};
  }

  static constexpr Eigen::Index read_beyond = 2;  ///< padding after the last node, because whole vectors are read

  node_grid<3> grid_;
  std::vector<float, huge_page_allocator<float>> values_;  ///< three channels per node
};

}  // namespace gonio::model::detail
