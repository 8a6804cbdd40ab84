#pragma once
/// Bodies of model/adaptive_brdf.hpp.

#include <gonio/core/arc_tangent.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/huge_pages.hpp>
#include <gonio/model/adaptive_brdf.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

namespace gonio::model::detail {

/// Linear interpolation. `std::lerp` has guarantees that cost more than the rest of a look-up.
[[nodiscard]] inline double mixed(double from, double to, double share) noexcept { return from + share * (to - from); }

/// Clamps to [0, 1]. Returns 0 for NaN.
[[nodiscard]] inline double within_unit(double number) noexcept { return std::min(std::max(0.0, number), 1.0); }

/// The position of a number between two neighbours in an ascending list.
struct between_neighbours {
  Eigen::Index first = 0;
  double fraction = 0.0;  ///< of the interval, from the first neighbour to the second
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

/// The polar angles of wi that have tables.
class light_angles {
 public:
  /// Takes angles in radians.
  explicit light_angles(const std::vector<double>& angles) {
    for (std::size_t i = 0; i + 1 < angles.size(); ++i) {
      from_.push_back(angles[i] * (2.0 / std::numbers::pi));
      per_quarter_turn_.push_back(0.5 * std::numbers::pi / (angles[i + 1] - angles[i]));
    }
  }

  /// Binary search; the angle is in quarter turns. It is branch-free, because successive angles are unpredictable.
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

/// Returns the azimuth of `w` minus that of `reference` in turns plus 1/2, in [0, 1). The normal has the azimuth of the
/// x axis.
[[nodiscard]] inline double relative_turn(const direction& w, const direction& reference) noexcept {
  double along = reference.x() * w.x() + reference.y() * w.y(), beside = reference.x() * w.y() - reference.y() * w.x();
  if (!(std::max(std::abs(along), std::abs(beside)) > 0.0)) {  // one is the normal
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
  Eigen::Index corner = 0;  ///< index of the first number of its first node
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

  /// Returns `Size` numbers from a patch's first node on, interpolated between two rows and between the table of
  /// `light` and the next. All `Size` numbers are read together, because a vector costs as much as one number.
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

/// Cumulative trapezoid sums of a table, in units of its patches.
struct table_sums {
  Eigen::Index columns;
  Eigen::ArrayXd along;   ///< sum of each row up to each column, row by row
  Eigen::ArrayXd across;  ///< sum of whole rows up to each row

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
  /// Also scales the densities in `density`.
  explicit visible_lookup(unit_square_tables& density) : grid_(density), row_sums_per_table_(2 * density.rows) {
    nodes_.reserve(2 * density.values.size());
    row_sums_.reserve(density.tables * row_sums_per_table_);
    const Eigen::Index size = density.rows * density.columns;
    for (Eigen::Index t = 0; t < density.tables; ++t) {
      const Eigen::Map<Eigen::ArrayXf> values(density.values.data() + t * size, size);
      const table_sums sums(values.data(), density.rows, density.columns);
      if (!(sums.total() > 0.0)) refuse({"no normals are visible from theta_i number ", t});
      append(sums, values);
    }
  }

  [[nodiscard]] square_point position(const square_point& half, const between_neighbours& light) const noexcept {
    const square_patch patch = grid_.find(half);
    const auto [across, along] = patch.inside;
    // Along the row: the trapezoids before the patch, plus the part of its own trapezoid up to the half vector.
    const auto [left, left_before, right, right_before] = grid_.mixed_rows<4, double>(nodes_.data(), patch, light);
    const double part = left_before + along * (left + 0.5 * along * (right - left));
    // Across the rows: the rows before the patch, plus the part of the patch.
    const float* near = row_sums_.data() + light.first * row_sums_per_table_ + 2 * patch.row;
    const float* far = near + row_sums_per_table_;
    std::array<double, 4> sums;
    for (std::size_t k = 0; k < 4; ++k) sums[k] = mixed(near[k], far[k], light.fraction);
    const auto [low, low_before, high, high_before] = sums;
    const double whole = mixed(low, high, across);
    return {within_unit(low_before + across * (low + 0.5 * across * (high - low))),
            whole > 0.0 ? within_unit(part / whole) : half.along};
  }

 private:
  /// Appends a table scaled to integral 1, because sums are interpolated between two theta_i.
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
      nodes_;                    ///< for each node: its density, and the trapezoids of its row up to it
  std::vector<float> row_sums_;  ///< for each row: its trapezoids, and those of whole rows up to it
};

/// Looks up reflectance. Three consecutive tables are the channels of one.
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

  /// Returns the value times a factor. The factor is applied before the last step: otherwise compilers would fuse one
  /// of the two products with their sum, and exchanging the two directions would change the last digit. Computes in
  /// float, like the nodes, with a relative error of 1e-7.
  [[nodiscard]] rgb value(const square_point& at, const between_neighbours& light, double factor) const noexcept {
    const square_patch patch = grid_.find(at);
    const std::array<float, 8> sides = grid_.mixed_rows<8, float>(values_.data(), patch, light);
    const double right = factor * patch.inside.along, left = factor - right;
    return {left * sides[0] + right * sides[3], left * sides[1] + right * sides[4], left * sides[2] + right * sides[5]};
  }

 private:
  static constexpr Eigen::Index read_beyond = 2;  ///< padding after the last node, because whole vectors are read

  node_grid<3> grid_;
  std::vector<float, huge_page_allocator<float>> values_;  ///< three channels per node
};

/// Whether a table may have negative numbers.
enum class table_sign { any, not_negative };

/// Throws gonio::error unless `part` has this many tables, all numbers are finite, and the signs are allowed.
inline void require_tables(const unit_square_tables& part, const char* name, Eigen::Index tables, table_sign sign) {
  if (part.tables != tables || part.rows < 2 || part.columns < 2 ||
      std::ssize(part.values) != part.tables * part.rows * part.columns)
    refuse({"the ", name, " needs ", tables, " tables of at least 2 x 2 numbers, not ", part.tables, " of ", part.rows,
            " x ", part.columns, " in ", part.values.size(), " numbers"});
  const auto bad = std::ranges::find_if(part.values, [&](float value) {
    return !std::isfinite(value) || (sign == table_sign::not_negative && value < 0.0f);
  });
  if (bad != part.values.end())
    refuse({"the ", name, " has the value ", *bad,
            sign == table_sign::any ? ", expected finite numbers" : ", expected finite numbers of at least 0"});
}

inline void require_material(const adaptive_brdf_parts& parts) {
  const std::vector<double>& angles = parts.theta_i;
  const auto possible = [](double angle) { return angle >= 0.0 && angle <= 0.5 * std::numbers::pi; };
  if (angles.size() < 2 || !std::ranges::all_of(angles, possible) ||
      std::ranges::adjacent_find(angles, std::ranges::greater_equal()) != angles.end())
    refuse("theta_i needs at least 2 ascending angles from 0 to pi/2");
  const auto count = std::ssize(angles);
  require_tables(parts.normals, "distribution of normals", 1, table_sign::not_negative);
  require_tables(parts.projected_area, "projected area", 1, table_sign::not_negative);
  require_tables(parts.visible_normals, "density of visible normals", count, table_sign::not_negative);
  require_tables(parts.reflectance, "reflectance", 3 * count, table_sign::any);
}

}  // namespace gonio::model::detail

namespace gonio::model {

struct adaptive_brdf::stored {
  explicit stored(adaptive_brdf_parts given)
      : parts(std::move(given)),
        light(parts.theta_i),
        normals(parts.normals),
        area(parts.projected_area),
        visible(parts.visible_normals),
        reflectance(parts.reflectance) {}

  /// The coordinates of the light and of a half vector of any length in the tables.
  struct place {
    double theta_i;  ///< in quarter turns
    detail::square_point half;

    place(const direction& wi, const direction& sum, double along) noexcept
        : theta_i(detail::within_unit(detail::polar_quarter_turn(wi))), half{detail::relative_turn(sum, wi), along} {}
  };

  /// The position at which the reflectance is looked up, and its factor.
  struct mapped {
    detail::between_neighbours light;
    detail::square_point position;
    double factor;
  };

  [[nodiscard]] mapped map(const place& at, double cos_theta_o) const noexcept {
    const detail::between_neighbours neighbours = light.find(at.theta_i);
    const double divisor = 4.0 * cos_theta_o * area.value({0.5, std::sqrt(at.theta_i)});
    return {neighbours, visible.position(at.half, neighbours), divisor > 0.0 ? normals.value(at.half) / divisor : 0.0};
  }

  [[nodiscard]] rgb value(const mapped& at) const noexcept {
    return reflectance.value(at.position, at.light, at.factor);
  }

  adaptive_brdf_parts parts;
  detail::light_angles light;
  detail::table_lookup normals, area;
  detail::visible_lookup visible;
  detail::reflectance_lookup reflectance;
};

GONIO_INLINE adaptive_brdf::adaptive_brdf(adaptive_brdf_parts parts) {
  detail::require_material(parts);
  tables_ = std::make_shared<const stored>(std::move(parts));
}

GONIO_INLINE const adaptive_brdf_parts& adaptive_brdf::parts() const noexcept { return tables_->parts; }

GONIO_INLINE rgb adaptive_brdf::operator()(const direction& wi, const direction& wo) const noexcept {
  if (!(wi.z() > 0.0 && wo.z() > 0.0)) return rgb::Zero();
  const direction sum = wi + wo;
  const double along = detail::polar_coordinate(sum);
  // Interleaves the steps of both orders, so that the processor computes one while it waits for the other.
  const stored& tables = *tables_;
  const stored::place first(wi, sum, along), second(wo, sum, along);
  const stored::mapped one = tables.map(first, wo.z()), other = tables.map(second, wi.z());
  return 0.5 * (tables.value(one) + tables.value(other));
}

GONIO_INLINE rgb adaptive_brdf::as_measured(const direction& wi, const direction& wo) const noexcept {
  if (!(wi.z() > 0.0 && wo.z() > 0.0)) return rgb::Zero();
  const direction sum = wi + wo;
  return tables_->value(tables_->map(stored::place(wi, sum, detail::polar_coordinate(sum)), wo.z()));
}

}  // namespace gonio::model
