#pragma once
/// Bodies of model/adaptive_brdf.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/model/adaptive_brdf.hpp>
#include <gonio/model/impl/adaptive_lookup.ipp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

namespace gonio::model::detail {

/// Whether a table may have negative numbers.
enum class table_sign { any, not_negative };

/// Throws gonio::error unless `part` has this many tables, all numbers are finite, and their signs are allowed.
inline void require_tables(const unit_square_tables& part, const char* name, Eigen::Index tables, table_sign sign) {
  if (part.tables != tables || part.rows < 2 || part.columns < 2 ||
      std::ssize(part.values) != part.tables * part.rows * part.columns)
    refuse({"the ", name, " needs ", tables, " tables of at least 2 x 2 numbers, not ", part.tables, " tables of ",
            part.rows, " x ", part.columns, " with ", part.values.size(), " numbers in all"});
  const auto bad = std::ranges::find_if(part.values, [&](float value) {
    return !std::isfinite(value) || (sign == table_sign::not_negative && value < 0.0f);
  });
  if (bad != part.values.end())
    refuse({"the ", name, " has the value ", *bad,
            sign == table_sign::any ? ", expected finite numbers" : ", expected finite numbers of at least 0"});
}

/// Returns the parts of a full turn that the azimuths of the light stand for: 1, 2 or 4. Throws gonio::error for
/// others.
[[nodiscard]] inline int symmetry_of(const std::vector<double>& phi_i) {
  constexpr double half_turn = std::numbers::pi, rounding = 1e-6;
  const auto possible = [](double angle) { return std::abs(angle) <= half_turn + rounding; };
  if (phi_i.size() < 3 || !std::ranges::all_of(phi_i, possible) ||
      std::ranges::adjacent_find(phi_i, std::ranges::greater_equal()) != phi_i.end())
    refuse("phi_i needs at least 3 ascending angles from -pi to pi");
  const double parts = std::round(2.0 * half_turn / (phi_i.back() - phi_i.front()));
  const double highest = parts == 1.0 ? half_turn : parts == 2.0 ? 0.0 : -0.5 * half_turn;
  if ((parts != 1.0 && parts != 2.0 && parts != 4.0) || phi_i.back() > highest + rounding)
    refuse({"phi_i is from ", phi_i.front(), " to ", phi_i.back(),
            ", expected a full turn from -pi, half a turn (to 0) or a quarter (to -pi/2)"});
  return static_cast<int>(parts);
}

inline void require_material(const adaptive_brdf_parts& parts) {
  const std::vector<double>& angles = parts.theta_i;
  const auto possible = [](double angle) { return angle >= 0.0 && angle <= 0.5 * std::numbers::pi; };
  if (angles.size() < 2 || !std::ranges::all_of(angles, possible) ||
      std::ranges::adjacent_find(angles, std::ranges::greater_equal()) != angles.end())
    refuse("theta_i needs at least 2 ascending angles from 0 to pi/2");
  if (parts.is_anisotropic()) static_cast<void>(symmetry_of(parts.phi_i));
  const Eigen::Index count = parts.lights();
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
        azimuths(parts.phi_i),
        symmetry(parts.is_anisotropic() ? detail::symmetry_of(parts.phi_i) : 0),
        normals(parts.normals),
        area(parts.projected_area),
        visible(parts.visible_normals),
        reflectance(parts.reflectance) {}

  /// The location of a half vector of any length in the tables: the light's polar angle, and the half vector's
  /// coordinates.
  struct table_location {
    double theta_i;  ///< polar angle of wi in quarter turns
    detail::square_point half;

    table_location(const direction& wi, const direction& sum, double along) noexcept
        : theta_i(detail::within_unit(detail::polar_quarter_turn(wi))), half{detail::relative_turn(sum, wi), along} {}
  };

  /// The location of the reflectance (neighbouring angles of the light, position in their tables), and the factor by
  /// which to multiply it.
  struct mapped {
    detail::between_neighbours light;
    detail::square_point position;
    double factor;
  };

  [[nodiscard]] mapped map(const table_location& at, double cos_theta_o) const noexcept {
    const detail::between_neighbours neighbours = light.find(at.theta_i);
    const double divisor = 4.0 * cos_theta_o * area.value({0.5, std::sqrt(at.theta_i)});
    return {neighbours, visible.position(at.half, neighbours), divisor > 0.0 ? normals.value(at.half) / divisor : 0.0};
  }

  [[nodiscard]] rgb value(const mapped& at) const noexcept {
    return reflectance.value(at.position, at.light, at.factor);
  }

  /// Returns the value of an anisotropic material as measured. `along` is the polar coordinate of the half vector.
  [[nodiscard]] rgb turned_value(direction wi, direction wo, double along) const noexcept {
    fold(wi, wo);
    const direction x(1.0, 0.0, 0.0);
    const detail::square_point half{detail::relative_turn(wi + wo, x), along};
    const double theta = detail::within_unit(detail::polar_quarter_turn(wi)), turn = detail::relative_turn(wi, x);
    const detail::between_neighbours angle = light.find(theta), azimuth = azimuths.find(4.0 * turn - 2.0);
    const Eigen::Index angles = std::ssize(parts.theta_i);
    const double divisor = 4.0 * wo.z() * area.value({turn, std::sqrt(theta)});
    return reflectance.value(visible.position(half, angle, azimuth, angles), angle, azimuth, angles,
                             divisor > 0.0 ? normals.value(half) / divisor : 0.0);
  }

  /// Turns or mirrors a pair so that the tables have the azimuth of the light.
  void fold(direction& wi, direction& wo) const noexcept {
    const bool mirrors_y = symmetry >= 2 && wi.y() > 0.0;
    const bool mirrors_x = symmetry == 4 ? wi.x() > 0.0 : mirrors_y;
    if (mirrors_x) wi.x() = -wi.x(), wo.x() = -wo.x();
    if (mirrors_y) wi.y() = -wi.y(), wo.y() = -wo.y();
  }

  adaptive_brdf_parts parts;
  detail::light_angles light, azimuths;
  int symmetry;  ///< parts of a full turn that the azimuths stand for; 0: isotropic
  detail::table_lookup normals, area;
  detail::visible_lookup visible;
  detail::reflectance_lookup reflectance;
};

GONIO_INLINE adaptive_brdf::adaptive_brdf(adaptive_brdf_parts parts) {
  detail::require_material(parts);
  tables_ = std::make_shared<const stored>(std::move(parts));
}

GONIO_INLINE const adaptive_brdf_parts& adaptive_brdf::parts() const noexcept { return tables_->parts; }

GONIO_INLINE bool adaptive_brdf::is_anisotropic() const noexcept { return tables_->symmetry != 0; }

GONIO_INLINE rgb adaptive_brdf::operator()(const direction& wi, const direction& wo) const noexcept {
  if (!(wi.z() > 0.0 && wo.z() > 0.0)) return rgb::Zero();
  const direction sum = wi + wo;
  const double along = detail::polar_coordinate(sum);
  const stored& tables = *tables_;
  if (tables.symmetry != 0) return 0.5 * (tables.turned_value(wi, wo, along) + tables.turned_value(wo, wi, along));
  // Interleave the steps for (wi, wo) and (wo, wi), so that the processor computes one value while it waits for the
  // other.
  const stored::table_location first(wi, sum, along), second(wo, sum, along);
  const stored::mapped one = tables.map(first, wo.z()), other = tables.map(second, wi.z());
  return 0.5 * (tables.value(one) + tables.value(other));
}

GONIO_INLINE rgb adaptive_brdf::as_measured(const direction& wi, const direction& wo) const noexcept {
  if (!(wi.z() > 0.0 && wo.z() > 0.0)) return rgb::Zero();
  const direction sum = wi + wo;
  const double along = detail::polar_coordinate(sum);
  if (tables_->symmetry != 0) return tables_->turned_value(wi, wo, along);
  return tables_->value(tables_->map(stored::table_location(wi, sum, along), wo.z()));
}

}  // namespace gonio::model
