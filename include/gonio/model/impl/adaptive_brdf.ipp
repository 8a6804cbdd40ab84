#pragma once
/// Bodies of model/adaptive_brdf.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/model/adaptive_brdf.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

namespace gonio::model::detail {

/// Between two numbers, without the guarantees of `std::lerp`, whose choices cost more than the rest of a look-up.
[[nodiscard]] inline double mixed(double from, double to, double share) noexcept { return from + share * (to - from); }

/// A point of the unit square.
struct square_point {
  double across = 0.0;  ///< the rows
  double along = 0.0;   ///< a row
};

/// The values of two neighbouring columns, interpolated between two rows.
struct patch_sides {
  double left = 0.0;
  double right = 0.0;
};

/// The patch between four nodes in which a point of the unit square lies, and where in it.
struct square_patch {
  Eigen::Index row = 0;
  Eigen::Index column = 0;
  square_point inside;

  square_patch(const unit_square_tables& tables, const square_point& at) noexcept {
    row = split(at.across, tables.rows, inside.across);
    column = split(at.along, tables.columns, inside.along);
  }

  [[nodiscard]] patch_sides sides(const unit_square_tables& tables, Eigen::Index table) const noexcept {
    const float* low = tables.row(table, row) + column;
    const float* high = tables.row(table, row + 1) + column;
    return {mixed(low[0], high[0], inside.across), mixed(low[1], high[1], inside.across)};
  }

  [[nodiscard]] double value(const unit_square_tables& tables, Eigen::Index table) const noexcept {
    const auto [left, right] = sides(tables, table);
    return mixed(left, right, inside.along);
  }

 private:
  static Eigen::Index split(double coordinate, Eigen::Index nodes, double& fraction) noexcept {
    const double scaled = std::clamp(coordinate, 0.0, 1.0) * static_cast<double>(nodes - 1);
    const double node = std::min(std::floor(scaled), static_cast<double>(nodes - 2));
    fraction = scaled - node;
    return static_cast<Eigen::Index>(node);
  }
};

/// Two neighbours among ascending angles, and how far an angle is towards the second.
struct neighbouring_angles {
  Eigen::Index first = 0;
  double fraction = 0.0;

  neighbouring_angles(const std::vector<double>& angles, double angle) noexcept {
    const auto second = std::upper_bound(angles.begin() + 1, angles.end() - 1, angle);
    const auto before = second - 1;
    first = before - angles.begin();
    fraction = std::clamp((angle - *before) / (*second - *before), 0.0, 1.0);
  }

  /// What `value(number)` is at the two, interpolated.
  template <class Value>
  [[nodiscard]] double interpolate(const Value& value) const noexcept {
    return mixed(value(first), value(first + 1), fraction);
  }

  /// The sides of a patch between the two's tables.
  [[nodiscard]] patch_sides sides(const square_patch& patch, const unit_square_tables& tables) const noexcept {
    const patch_sides near = patch.sides(tables, first), far = patch.sides(tables, first + 1);
    return {mixed(near.left, far.left, fraction), mixed(near.right, far.right, fraction)};
  }
};

/// Of a polar angle, along the rows.
[[nodiscard]] inline double polar_coordinate(double polar_angle) noexcept {
  return std::sqrt(polar_angle * (2.0 / std::numbers::pi));
}

/// The azimuth of `w` relative to that of `reference`, radians; the normal has that of the x axis.
[[nodiscard]] inline double relative_azimuth(const direction& w, const direction& reference) noexcept {
  const auto x_of = [](const direction& v) { return v.x() == 0.0 && v.y() == 0.0 ? 1.0 : v.x(); };
  const double x = x_of(reference), w_x = x_of(w);
  return std::atan2(x * w.y() - reference.y() * w_x, x * w_x + reference.y() * w.y());
}

/// The trapezoids of a table, in units of its patches.
struct table_sums {
  Eigen::Index columns;
  Eigen::ArrayXd along;   ///< of each row up to each column, row after row
  Eigen::ArrayXd across;  ///< of whole rows up to each of them

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

/// Where the cumulative distribution of visible normals maps a half vector.
[[nodiscard]] inline square_point visible_position(const unit_square_tables& density, const unit_square_tables& along,
                                                   const unit_square_tables& across, const square_point& half,
                                                   const neighbouring_angles& angles) noexcept {
  const square_patch patch(density, half);
  const square_point& inside = patch.inside;
  // Along the rows: the trapezoids before the patch, and the part of its own on this side of the half vector.
  const auto [left, right] = angles.sides(patch, density);
  const double before = angles.sides(patch, along).left;
  const double part = before + inside.along * (left + 0.5 * inside.along * (right - left));
  // Across the rows: those before the patch, and the part of its own.
  const auto row_sum = [&](Eigen::Index row) {
    return angles.interpolate([&](Eigen::Index t) { return along.row(t, row)[along.columns - 1]; });
  };
  const double low = row_sum(patch.row), high = row_sum(patch.row + 1);
  const double rows_before = angles.interpolate([&](Eigen::Index t) { return across.row(0, t)[patch.row]; });
  const double whole = mixed(low, high, inside.across);
  return {rows_before + inside.across * (low + 0.5 * inside.across * (high - low)),
          whole > 0.0 ? part / whole : half.along};
}

/// May numbers be negative?
enum class table_sign { any, not_negative };

/// Throws gonio::error unless a part of the material has this many tables, of finite numbers.
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

GONIO_INLINE adaptive_brdf::adaptive_brdf(adaptive_brdf_parts parts) {
  detail::require_material(parts);
  tables_ = std::make_shared<const stored>(summed_up(std::move(parts)));
}

GONIO_INLINE adaptive_brdf::stored adaptive_brdf::summed_up(adaptive_brdf_parts parts) {
  unit_square_tables& density = parts.visible_normals;
  const auto [tables, rows, columns] = std::tuple(density.tables, density.rows, density.columns);
  unit_square_tables along = density;
  unit_square_tables across{1, tables, rows, std::vector<float>(tables * rows)};
  const Eigen::Index size = rows * columns;
  for (Eigen::Index t = 0; t < tables; ++t) {
    Eigen::Map<Eigen::ArrayXf> values(density.values.data() + t * size, size);
    const detail::table_sums sums(values.data(), rows, columns);
    // Scale the whole to 1: between two theta_i, sums are interpolated.
    const double sum = sums.total();
    if (!(sum > 0.0)) refuse({"no normals are visible from theta_i number ", t});
    values = (values.cast<double>() / sum).cast<float>();
    Eigen::Map<Eigen::ArrayXf>(along.values.data() + t * size, size) = (sums.along / sum).cast<float>();
    Eigen::Map<Eigen::ArrayXf>(across.values.data() + t * rows, rows) = (sums.across / sum).cast<float>();
  }
  return {std::move(parts), std::move(along), std::move(across)};
}

GONIO_INLINE rgb adaptive_brdf::as_measured(const direction& wi, const direction& wo) const noexcept {
  if (!(wi.z() > 0.0 && wo.z() > 0.0)) return rgb::Zero();
  const auto& [theta_i, normals, area, visible, reflectance] = tables_->parts;
  // Map the half vector to the unit square, its azimuth relative to the light's.
  const direction sum = wi + wo;
  const double turns = detail::relative_azimuth(sum, wi) / (2.0 * std::numbers::pi) + 0.5;
  const double theta = polar_angle(wi);
  const detail::square_point half{turns - std::floor(turns), detail::polar_coordinate(polar_angle(sum))};
  const detail::square_point light{0.5, detail::polar_coordinate(theta)};
  // Look the three channels up where the visible normals map it to, and undo what they were divided by.
  const double divisor = 4.0 * wo.z() * detail::square_patch(area, light).value(area, 0);
  if (!(divisor > 0.0)) return rgb::Zero();
  const double scale = detail::square_patch(normals, half).value(normals, 0) / divisor;
  const detail::neighbouring_angles angles(theta_i, theta);
  const detail::square_patch patch(
      reflectance, detail::visible_position(visible, tables_->along_rows, tables_->across_rows, half, angles));
  rgb value;
  for (Eigen::Index c = 0; c < 3; ++c)
    value[c] = scale * angles.interpolate([&](Eigen::Index t) { return patch.value(reflectance, 3 * t + c); });
  return value;
}

}  // namespace gonio::model
