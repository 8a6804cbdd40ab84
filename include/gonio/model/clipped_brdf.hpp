#pragma once
/// BRDFs without negative values, as renderers need them: a renderer would subtract negative reflection from other
/// light. Measured values can be negative because of colours outside the gamut, noise or a subtracted dark signal.

#include <gonio/core/brdf.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/model/adaptive_brdf.hpp>
#include <gonio/model/physical_properties.hpp>
#include <gonio/model/tabulate_adaptively.hpp>
#include <gonio/table/valid_cells.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace gonio::model {

/// A BRDF with negative values set to zero.
template <brdf Brdf>
class clipped_brdf {
 public:
  explicit clipped_brdf(Brdf f) : f_(std::move(f)) {}

  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept {
    return rgb(f_(wi, wo)).max(0.0);
  }

 private:
  Brdf f_;
};

/// The changes that `clipped_brdf` makes.
struct clipped_values {
  Eigen::Index cells = 0;  ///< number of cells with a negative value in any channel
  /// Increase of each channel's reflected light under uniform illumination, relative to the reflected light averaged
  /// over the channels.
  rgb added{rgb::Zero()};
};

/// Directions in which negative values are sought: the cells' directions, for anisotropic BRDFs turned about the
/// normal, each by the golden angle more than the one before, which reaches all azimuths.
enum class cell_azimuths { zero, all };

/// Counts the cells at which a BRDF has negative values, and integrates the light that clipping adds. O(cells), plus at
/// most 129,600 evaluations of f if there are negative values.
template <brdf Brdf>
[[nodiscard]] clipped_values count_negative_values(const Brdf& f, const valid_cells& cells,
                                                   cell_azimuths azimuths = cell_azimuths::zero) {
  clipped_values found;
  const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (Eigen::Index cell = 0; cell < cells.size(); ++cell) {
    direction_pair pair = to_directions(cells.angles(cell));
    if (azimuths == cell_azimuths::all) {
      const double turn = golden_angle * static_cast<double>(cell);
      pair = {turned_about_normal(pair.wi, turn), turned_about_normal(pair.wo, turn)};
    }
    if ((rgb(f(pair.wi, pair.wo)) < 0.0).any()) ++found.cells;
  }
  if (found.cells == 0) return found;
  constexpr int bins = 60;
  rgb reflected = rgb::Zero(), without = rgb::Zero();
  for (const double azimuth : {0.0, 45.0, 90.0, 135.0}) {
    if (azimuth > 0.0 && azimuths == cell_azimuths::zero) break;
    const auto measured = [&f, turn = radians(azimuth)](const direction& wi, const direction& wo) noexcept -> rgb {
      return f(turned_about_normal(wi, turn), turned_about_normal(wo, turn));
    };
    const clipped_brdf clipped(measured);
    for (int degree = 0; degree < 90; degree += 5) {
      const double theta = radians(degree + 2.5);
      reflected += std::sin(2.0 * theta) * directional_albedo(measured, theta, bins);
      without += std::sin(2.0 * theta) * directional_albedo(clipped, theta, bins);
    }
  }
  found.added = (without - reflected) / std::max(without.mean(), 1e-12);
  return found;
}

/// Counts the negative values of a material of the RGL database, as measured, with light and viewer in both orders.
/// Ignores values with light or viewer within 6 degrees of the horizon, because negative values below the horizon
/// affect them.
[[nodiscard]] inline clipped_values count_negative_values(const adaptive_brdf& material, const valid_cells& cells) {
  constexpr double lowest_cosine = 0.1;
  const auto measured = [&](const direction& wi, const direction& wo) noexcept -> rgb {
    if (std::min(wi.z(), wo.z()) < lowest_cosine) return rgb::Zero();
    return material.as_measured(wi, wo).min(material.as_measured(wo, wi));
  };
  return count_negative_values<decltype(measured)>(
      measured, cells, material.is_anisotropic() ? cell_azimuths::all : cell_azimuths::zero);
}

/// Returns a copy of the material with negative values above the horizon set to zero. Its normals do not change.
[[nodiscard]] inline adaptive_brdf clipped(const adaptive_brdf& material, thread_count threads = {}) {
  const auto measured = [&](const direction& wi, const direction& wo) noexcept -> rgb {
    return material.as_measured(wi, wo).max(0.0);
  };
  adaptive_brdf_parts parts = material.parts();
  parts.reflectance = tabulate_over(material, measured, threads);
  return adaptive_brdf(std::move(parts));
}

}  // namespace gonio::model
