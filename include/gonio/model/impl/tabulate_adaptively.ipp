#pragma once
/// Bodies of model/tabulate_adaptively.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/model/adaptive_brdf.hpp>
#include <gonio/model/impl/adaptive_brdf.ipp>
#include <gonio/model/tabulate_adaptively.hpp>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace gonio::model::detail {

inline constexpr double quarter_turn = 0.5 * std::numbers::pi;
/// Values at the horizon are evaluated slightly above it, where a BRDF is defined.
inline constexpr double highest_angle = quarter_turn - 1e-3;
/// The fraction of normals that are distributed as on an extremely rough surface. They give values far from the
/// highlight a part of the tables, and keep the density of every normal above zero.
inline constexpr double rough_share = 0.2;

/// Returns the coordinate of a node, from 0 to 1.
[[nodiscard]] inline double unit_coordinate(Eigen::Index node, Eigen::Index nodes) {
  return static_cast<double>(node) / static_cast<double>(nodes - 1);
}

/// Returns the polar angle in radians of a coordinate along a row of the tables: the inverse of `polar_coordinate`.
[[nodiscard]] inline double polar_angle_at(double along) { return quarter_turn * along * along; }

/// Returns the integral of max(0, m . w) over the azimuth of m, given the polar angles of m and w.
[[nodiscard]] inline double projected_ring(double theta_m, double theta) {
  const double up = std::cos(theta_m) * std::cos(theta), aside = std::sin(theta_m) * std::sin(theta);
  if (up >= aside) return 2.0 * std::numbers::pi * up;
  const double limit = std::acos(-up / aside);
  return 2.0 * (up * limit + aside * std::sin(limit));
}

/// A distribution of normals over polar angles. The angles are at equal steps of the coordinate along a row of the
/// tables.
class normal_distribution {
 public:
  /// Computes the distribution from the retroreflection of f.
  normal_distribution(const brdf_function& f, Eigen::Index nodes)
      : theta_(nodes), weights_(nodes), rings_(nodes, nodes), density_(nodes) {
    for (Eigen::Index i = 0; i < nodes; ++i) {
      const double along = unit_coordinate(i, nodes);
      theta_[i] = polar_angle_at(along);
      // The trapezoidal rule with d theta = pi along d along.
      const double step = (i == 0 || i == nodes - 1 ? 0.5 : 1.0) / static_cast<double>(nodes - 1);
      weights_[i] = std::numbers::pi * along * std::sin(theta_[i]) * step;
    }
    for (Eigen::Index i = 0; i < nodes; ++i)
      for (Eigen::Index j = 0; j < nodes; ++j) rings_(i, j) = projected_ring(theta_[j], theta_[i]) * weights_[j];
    Eigen::ArrayXd back(nodes);
    for (Eigen::Index i = 0; i < nodes; ++i) {
      const direction m = spherical_direction(std::min(theta_[i], highest_angle), 0.0);
      back[i] = std::max(luminance(f(m, m)), 0.0) * m.z();
    }
    iterate(back);
  }

  [[nodiscard]] const Eigen::ArrayXd& density() const noexcept { return density_; }

  [[nodiscard]] Eigen::ArrayXd projected_area() const {
    Eigen::ArrayXd area(theta_.size());
    for (Eigen::Index i = 0; i < area.size(); ++i) area[i] = (rings_.row(i).transpose() * density_).sum();
    return area;
  }

 private:
  static constexpr int iterations = 16;

  void iterate(const Eigen::ArrayXd& back) {
    // If f has no retroreflection, keep the normals of an extremely rough surface.
    density_.setConstant(std::numbers::inv_pi);
    if (!(back > 0.0).any()) return;

    for (int i = 0; i < iterations; ++i) density_ = normalised(back * projected_area());
    density_ = (1.0 - rough_share) * density_ + rough_share * std::numbers::inv_pi;
  }

  /// Scales the density so that the projected area seen from above is 1.
  [[nodiscard]] Eigen::ArrayXd normalised(const Eigen::ArrayXd& density) const {
    return density / (2.0 * std::numbers::pi * (density * theta_.cos() * weights_).sum());
  }

  Eigen::ArrayXd theta_, weights_;
  Eigen::ArrayXXd rings_;
  Eigen::ArrayXd density_;
};

[[nodiscard]] inline direction half_vector_at(const square_point& at) {
  return spherical_direction(polar_angle_at(at.along), (2.0 * at.across - 1.0) * std::numbers::pi);
}

/// The distribution of normals of an anisotropic material, over azimuth and polar angle.
class turned_normal_distribution {
 public:
  /// Computes it from the retroreflection of f.
  turned_normal_distribution(const brdf_function& f, Eigen::Index nodes, thread_count threads)
      : nodes_(nodes), normals_(nodes * nodes, 3), weights_(nodes * nodes), density_(nodes * nodes) {
    Eigen::ArrayXd back(nodes * nodes);
    for (Eigen::Index i = 0; i < back.size(); ++i) {
      const square_point at = node(i);
      const direction m = half_vector_at(at);
      normals_.row(i) = m.transpose();
      // d theta = pi along d along, d phi = 2 pi d across, by the trapezoidal rule.
      weights_[i] = 2.0 * std::numbers::pi * std::numbers::pi * at.along * std::hypot(m.x(), m.y()) * step(i / nodes) *
                    step(i % nodes);
      const direction above = spherical_direction(std::min(polar_angle_at(at.along), highest_angle), azimuth(m));
      back[i] = std::max(luminance(f(above, above)), 0.0) * above.z();
    }
    iterate(back, threads);
  }

  [[nodiscard]] unit_square_tables density() const {
    unit_square_tables table{1, nodes_, nodes_, std::vector<float>(density_.size())};
    Eigen::Map<Eigen::ArrayXf>(table.values.data(), density_.size()) = density_.cast<float>();
    return table;
  }

  /// Returns the projected area over directions. It is smoother than the density, so half as many nodes suffice.
  [[nodiscard]] unit_square_tables projected_area(thread_count threads) const {
    const Eigen::Index side = nodes_ / 2 + 1;
    unit_square_tables area{1, side, side, std::vector<float>(side * side)};
    const Eigen::ArrayXd weighted = density_ * weights_;
    for_each_index(
        area.values.size(), 16,
        [&](Eigen::Index i) {
          const direction w = half_vector_at({unit_coordinate(i / side, side), unit_coordinate(i % side, side)});
          const Eigen::ArrayXd cosines = w.x() * normals_.col(0) + w.y() * normals_.col(1) + w.z() * normals_.col(2);
          area.values[i] = static_cast<float>((cosines.max(0.0) * weighted).sum());
        },
        threads);
    return area;
  }

 private:
  static constexpr int iterations = 16;

  [[nodiscard]] square_point node(Eigen::Index i) const {
    return {unit_coordinate(i / nodes_, nodes_), unit_coordinate(i % nodes_, nodes_)};
  }
  [[nodiscard]] double step(Eigen::Index number) const {
    return (number == 0 || number == nodes_ - 1 ? 0.5 : 1.0) / static_cast<double>(nodes_ - 1);
  }

  void iterate(const Eigen::ArrayXd& back, thread_count threads) {
    density_.setConstant(std::numbers::inv_pi);
    if (!(back > 0.0).any()) return;
    for (int i = 0; i < iterations; ++i) {
      const unit_square_tables area = projected_area(threads);
      const table_lookup area_at(area);
      for (Eigen::Index j = 0; j < back.size(); ++j) density_[j] = back[j] * area_at.value(node(j));
      density_ /= (density_ * normals_.col(2) * weights_).sum();
    }
    density_ = (1.0 - rough_share) * density_ + rough_share * std::numbers::inv_pi;
  }

  Eigen::Index nodes_;
  Eigen::ArrayX3d normals_;  ///< row by row: of each azimuth, all polar angles
  Eigen::ArrayXd weights_, density_;
};

/// Returns the x in [0, 1] at which a density that rises linearly from `low` to `high` has the integral `wanted`.
[[nodiscard]] inline double linear_quantile(double low, double high, double wanted) {
  const double root = std::sqrt(std::max(low * low + 2.0 * (high - low) * wanted, 0.0));
  return low + root > 0.0 ? std::clamp(2.0 * wanted / (low + root), 0.0, 1.0) : 0.0;
}

/// For one theta_i, computes the inverse of `visible_lookup::position`.
class visible_normal_quantiles {
 public:
  visible_normal_quantiles(const float* density, Eigen::Index rows, Eigen::Index columns)
      : density_(density), sums_(density, rows, columns) {}

  [[nodiscard]] square_point operator()(const square_point& position) const {
    const double rows_wanted = inside(position.across) * sums_.total();
    const Eigen::Index row = interval(sums_.across.size(), rows_wanted, [&](auto i) { return sums_.across[i]; });
    const double across =
        linear_quantile(sums_.row_total(row), sums_.row_total(row + 1), rows_wanted - sums_.across[row]);
    const auto between_rows = [&](const auto& values, Eigen::Index column) {
      const Eigen::Index low = row * sums_.columns + column;
      return std::lerp(double{values[low]}, double{values[low + sums_.columns]}, across);
    };
    const auto sum_at = [&](Eigen::Index column) { return between_rows(sums_.along, column); };
    const double wanted = inside(position.along) * sum_at(sums_.columns - 1);
    const Eigen::Index column = interval(sums_.columns, wanted, sum_at);
    const double along =
        linear_quantile(between_rows(density_, column), between_rows(density_, column + 1), wanted - sum_at(column));
    return {(static_cast<double>(row) + across) / static_cast<double>(sums_.across.size() - 1),
            (static_cast<double>(column) + along) / static_cast<double>(sums_.columns - 1)};
  }

 private:
  /// Clamps a coordinate to just inside of [0, 1]. A border then maps to the nearest visible point.
  [[nodiscard]] static double inside(double coordinate) { return std::clamp(coordinate, 1e-6, 1.0 - 1e-6); }

  /// Returns the last interval between nodes whose sum at its start is below `wanted`. The sums must not decrease.
  template <class Sum>
  [[nodiscard]] static Eigen::Index interval(Eigen::Index nodes, double wanted, const Sum& sum) {
    Eigen::Index low = 0, high = nodes - 1;
    while (high - low > 1) {
      const Eigen::Index middle = (low + high) / 2;
      (sum(middle) < wanted ? low : high) = middle;
    }
    return low;
  }

  const float* density_;
  table_sums sums_;
};

/// Returns f(wi, wo) cos(theta_o). If wo is below the horizon, extrapolates linearly in cos(theta_o).
[[nodiscard]] inline rgb continued_cosine_value(const brdf_function& f, const direction& wi, const direction& wo) {
  constexpr double lowest_cosine = 0.02;
  if (wo.z() > 0.0) return f(wi, wo) * wo.z();
  const double scale = std::sqrt((1.0 - lowest_cosine * lowest_cosine) / (1.0 - wo.z() * wo.z()));
  const direction above(scale * wo.x(), scale * wo.y(), lowest_cosine);
  return wo.z() * f(wi, above);
}

/// Returns a table of two equal rows, for a function that does not depend on the azimuth.
[[nodiscard]] inline unit_square_tables isotropic_table(const Eigen::ArrayXd& row) {
  unit_square_tables table{1, 2, row.size(), std::vector<float>(2 * row.size())};
  Eigen::Map<Eigen::ArrayXXf>(table.values.data(), row.size(), 2).colwise() = row.cast<float>();
  return table;
}

[[nodiscard]] inline double normal_density_at(const unit_square_tables& normals, const square_point& at) {
  return table_lookup(normals).value(at);
}

[[nodiscard]] inline direction light_at(const adaptive_brdf_parts& parts, Eigen::Index number) {
  const Eigen::Index angles = std::ssize(parts.theta_i);
  return spherical_direction(std::min(parts.theta_i[number % angles], highest_angle),
                             parts.is_anisotropic() ? parts.phi_i[number / angles] : 0.0);
}

/// Returns the projected area towards the light.
[[nodiscard]] inline double area_towards(const adaptive_brdf_parts& parts, const direction& wi) {
  const double turn = parts.is_anisotropic() ? relative_turn(wi, direction(1.0, 0.0, 0.0)) : 0.5;
  return table_lookup(parts.projected_area).value({turn, polar_coordinate(wi)});
}

/// Fills the three tables of f at one direction of the light, over the normals of a material. `reflectance` gives their
/// size.
inline void fill_reflectance(const brdf_function& f, const adaptive_brdf_parts& parts, Eigen::Index number,
                             unit_square_tables& reflectance) {
  const unit_square_tables& visible = parts.visible_normals;
  const visible_normal_quantiles quantiles(visible.row(number, 0), visible.rows, visible.columns);
  const direction wi = light_at(parts, number);
  const double area = area_towards(parts, wi);
  const Eigen::Index size = reflectance.rows * reflectance.columns;
  float* red = reflectance.values.data() + 3 * number * size;
  for (Eigen::Index i = 0; i < size; ++i) {
    const square_point half = quantiles({unit_coordinate(i / reflectance.columns, reflectance.rows),
                                         unit_coordinate(i % reflectance.columns, reflectance.columns)});
    const direction m = half_vector_at(half);
    const direction wo = 2.0 * m.dot(wi) * m - wi;
    const rgb value = continued_cosine_value(f, wi, wo) * (4.0 * area / normal_density_at(parts.normals, half));
    for (Eigen::Index c = 0; c < 3; ++c) red[c * size + i] = static_cast<float>(value[c]);
  }
}

/// Fills the tables of a material, one direction of the light at a time.
class adaptive_tabulation {
 public:
  adaptive_tabulation(const brdf_function& f, const adaptive_resolution& resolution) : f_(f) {
    const normal_distribution distribution(f, resolution.normals);
    parts_.normals = isotropic_table(distribution.density());
    parts_.projected_area = isotropic_table(distribution.projected_area());
    resize(resolution.theta_i, resolution.visible_normals, resolution.values);
  }

  adaptive_tabulation(const brdf_function& f, const anisotropic_resolution& resolution, thread_count threads) : f_(f) {
    const turned_normal_distribution distribution(f, resolution.normals, threads);
    parts_.normals = distribution.density();
    parts_.projected_area = distribution.projected_area(threads);
    for (Eigen::Index i = 0; i < resolution.phi_i; ++i)
      parts_.phi_i.push_back(std::numbers::pi * (2.0 * unit_coordinate(i, resolution.phi_i) - 1.0));
    resize(resolution.theta_i, resolution.visible_normals, resolution.values);
  }

  /// Returns the number of directions of the light.
  [[nodiscard]] Eigen::Index lights() const noexcept { return parts_.lights(); }

  /// Fills the tables of one direction of the light.
  void fill(Eigen::Index number) {
    fill_visible_normals(number, light_at(parts_, number));
    fill_reflectance(f_, parts_, number, parts_.reflectance);
  }

  [[nodiscard]] adaptive_brdf_parts parts() && { return std::move(parts_); }

 private:
  void resize(Eigen::Index angles, Eigen::Index visible, Eigen::Index values) {
    for (Eigen::Index i = 0; i < angles; ++i) parts_.theta_i.push_back(quarter_turn * unit_coordinate(i, angles));
    const Eigen::Index all = parts_.lights();
    parts_.visible_normals = {all, visible, visible, std::vector<float>(all * visible * visible)};
    parts_.reflectance = {3 * all, values, values, std::vector<float>(3 * all * values * values)};
  }

  void fill_visible_normals(Eigen::Index number, const direction& wi) {
    unit_square_tables& visible = parts_.visible_normals;
    Eigen::Index at = number * visible.rows * visible.columns;
    for (Eigen::Index row = 0; row < visible.rows; ++row)
      for (Eigen::Index column = 0; column < visible.columns; ++column) {
        const square_point node{unit_coordinate(row, visible.rows), unit_coordinate(column, visible.columns)};
        const direction m = half_vector_at(node);
        // The density per unit square, from the density per solid angle, up to a constant factor.
        const double jacobian = node.along * std::hypot(m.x(), m.y());
        visible.values[at++] =
            static_cast<float>(normal_density_at(parts_.normals, node) * std::max(wi.dot(m), 0.0) * jacobian);
      }
  }

  const brdf_function& f_;
  adaptive_brdf_parts parts_;
};

inline void require_resolution(std::initializer_list<Eigen::Index> counts) {
  for (const Eigen::Index count : counts)
    if (count < 2 || count > 4096) refuse({"adaptive tables need from 2 to 4096 numbers along each axis, not ", count});
}

[[nodiscard]] inline adaptive_brdf_parts filled(adaptive_tabulation&& tabulation, thread_count threads) {
  for_each_index(
      tabulation.lights(), 1, [&](Eigen::Index number) { tabulation.fill(number); }, threads);
  return std::move(tabulation).parts();
}

GONIO_INLINE adaptive_brdf_parts tabulated_adaptively(const brdf_function& f, const adaptive_resolution& resolution,
                                                      thread_count threads) {
  const auto [angles, values, visible, normals] = resolution;
  require_resolution({angles, values, visible, normals});
  return filled(adaptive_tabulation(f, resolution), threads);
}

GONIO_INLINE adaptive_brdf_parts tabulated_adaptively(const brdf_function& f, const anisotropic_resolution& resolution,
                                                      thread_count threads) {
  const auto [azimuths, angles, values, visible, normals] = resolution;
  require_resolution({angles, values, visible, normals});
  if (azimuths < 3 || azimuths > 4096)
    refuse({"anisotropic tables need from 3 to 4096 azimuths of the light, not ", azimuths});
  return filled(adaptive_tabulation(f, resolution, threads), threads);
}

GONIO_INLINE unit_square_tables tabulated_over(const brdf_function& f, const adaptive_brdf_parts& normals,
                                               thread_count threads) {
  unit_square_tables reflectance = normals.reflectance;
  for_each_index(
      normals.lights(), 1, [&](Eigen::Index number) { fill_reflectance(f, normals, number, reflectance); }, threads);
  return reflectance;
}

}  // namespace gonio::model::detail
