#pragma once
/// The readings of industrial appearance instruments, computed from a BRDF in each instrument's geometry: specular
/// gloss (ISO 2813, ASTM D523), reflection haze (ISO 13803, ASTM E430), reflectance at 8 degrees with and without the
/// specular part (CIE 15), total integrated scatter, and L*a*b* at the angles of multi-angle instruments (ASTM E2194).
/// Colours are linear Rec. 709 under D65 for the CIE 1931 observer. An instrument's lamp and filters are not modelled.

#include <gonio/core/brdf.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/fresnel.hpp>
#include <gonio/core/rgb.hpp>
#include <gonio/model/physical_properties.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace gonio::model {

/// The angular size of a rectangular aperture: full angles in radians.
struct field_angles {
  double in_plane = 0.0, across = 0.0;
};

/// A source and a receptor that face the same spot. All angles are in radians.
struct reflectometer {
  double theta_i = 0.0;     ///< angle of the source's centre from the normal
  double off_mirror = 0.0;  ///< angle of the receptor's centre from the mirror direction, away from the normal
  field_angles source, receptor;
};

/// Returns the geometry of specular gloss at 20, 60 or 85 degrees: ISO 2813:2014, Table 1. Throws for other angles.
[[nodiscard]] reflectometer gloss_meter(int degrees);

/// Returns the geometry of reflection haze at 20 degrees for one of its two receptors: 1.8 by 5.5 degrees, centred 1.9
/// degrees from the mirror direction towards the normal (side -1) or away from it (+1). ISO 13803.
[[nodiscard]] reflectometer haze_meter(int side);

/// Returns the fraction of unpolarised light at `theta_i` (radians) that the gloss standard reflects. The standard is
/// polished black glass of refractive index 1.567.
[[nodiscard]] double gloss_standard_reflectance(double theta_i);

namespace detail {

/// The positive nodes of 16-point Gauss-Legendre quadrature on [-1, 1]. The negative nodes are their mirror images.
struct quadrature_node {
  double at = 0.0, weight = 0.0;
};
inline constexpr std::array<quadrature_node, 8> gauss_legendre_16{{{0.0950125098376375, 0.1894506104550686},
                                                                   {0.2816035507792589, 0.1826034150449236},
                                                                   {0.4580167776572274, 0.1691565193950026},
                                                                   {0.6178762444026438, 0.1495959888165768},
                                                                   {0.7554044083550030, 0.1246289712555340},
                                                                   {0.8656312023878318, 0.0951585116824926},
                                                                   {0.9445750230732326, 0.0622535239386477},
                                                                   {0.9894009349916499, 0.0271524594117540}}};

/// Calls `add(x, weight)` at the quadrature nodes of an integral over [from, to]. The nodes are dense at 0, where the
/// highlight is: x = t^3, with two panels in t on each side of 0.
template <class Add>
void integrate_around_zero(double from, double to, const Add& add) {
  if (from < 0.0 && to > 0.0) {
    integrate_around_zero(from, 0.0, add);
    return integrate_around_zero(0.0, to, add);
  }
  constexpr int panels = 2;
  const double begin = std::cbrt(from), half = 0.5 * (std::cbrt(to) - begin) / panels;
  for (int panel = 0; panel < panels; ++panel)
    for (const quadrature_node& node : gauss_legendre_16)
      for (const double at : {-node.at, node.at}) {
        const double t = begin + half * (2.0 * panel + 1.0 + at);
        add(t * t * t, 3.0 * t * t * half * node.weight);
      }
}

/// Returns the direction that is `in_plane` radians from the normal in the plane of incidence, tilted out of this plane
/// by `across` radians.
[[nodiscard]] inline direction tilted(double in_plane, double across) noexcept {
  return {std::sin(in_plane) * std::cos(across), std::sin(across), std::cos(in_plane) * std::cos(across)};
}

}  // namespace detail

/// Returns the fraction of the source's light that reaches the receptor, in each channel: the integral of f cos theta_o
/// over the receptor, averaged over the source's directions. At most 36,864 evaluations. Misses highlights narrower
/// than 1e-5 radians.
template <brdf Brdf>
[[nodiscard]] rgb reflected_share(const Brdf& f, const reflectometer& meter) {
  constexpr std::array source_nodes{-0.7745966692414834, 0.0, 0.7745966692414834};
  constexpr std::array source_weights{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  const double centre = meter.theta_i + meter.off_mirror;
  rgb sum = rgb::Zero();
  for (std::size_t i = 0; i < source_nodes.size(); ++i)
    for (std::size_t k = 0; k < source_nodes.size(); ++k) {
      const double theta = meter.theta_i + 0.5 * meter.source.in_plane * source_nodes[i];
      const double across = 0.5 * meter.source.across * source_nodes[k];
      const direction wi = detail::tilted(-theta, -across);
      // The mirror direction of wi is at (theta, across) from the normal.
      const double first = centre - 0.5 * meter.receptor.in_plane - theta, last = first + meter.receptor.in_plane;
      const double low = -0.5 * meter.receptor.across - across, high = low + meter.receptor.across;
      detail::integrate_around_zero(first, last, [&](double x, double weight_x) {
        detail::integrate_around_zero(low, high, [&](double y, double weight_y) {
          const direction wo = detail::tilted(theta + x, across + y);
          if (!(wo.z() > 0.0)) return;
          const double area = weight_x * weight_y * std::cos(across + y);
          sum += rgb(f(wi, wo)) * (source_weights[i] * source_weights[k] * area * wo.z());
        });
      });
    }
  return sum;
}

/// Returns specular gloss at 20, 60 or 85 degrees, in gloss units. The gloss standard has 100 at each angle; a perfect
/// mirror has 2,038 at 20 degrees, 999 at 60 degrees and 162 at 85 degrees.
template <brdf Brdf>
[[nodiscard]] double specular_gloss(const Brdf& f, int degrees) {
  const reflectometer meter = gloss_meter(degrees);
  return 100.0 * luminance(reflected_share(f, meter)) / gloss_standard_reflectance(meter.theta_i);
}

/// Returns reflection haze at 20 degrees, in gloss units: the mean of the two receptors beside the mirror direction.
template <brdf Brdf>
[[nodiscard]] double reflection_haze(const Brdf& f) {
  const double both = luminance(reflected_share(f, haze_meter(-1))) + luminance(reflected_share(f, haze_meter(+1)));
  return 50.0 * both / gloss_standard_reflectance(radians(20.0));
}

/// Returns the fraction of the light from `theta_i` that is reflected within a cone around the mirror direction, in
/// each channel. Angles in radians; `half_angle` at most pi / 2 - `theta_i`. 1,024 evaluations.
template <brdf Brdf>
[[nodiscard]] rgb share_within_cone(const Brdf& f, double theta_i, double half_angle) {
  constexpr int azimuths = 32;
  const direction wi = detail::tilted(-theta_i, 0.0), mirror = detail::tilted(theta_i, 0.0);
  rgb sum = rgb::Zero();
  detail::integrate_around_zero(0.0, half_angle, [&](double angle, double weight) {
    for (int k = 0; k < azimuths; ++k) {
      const direction wo = turned(mirror, angle, (k + 0.5) * 2.0 * std::numbers::pi / azimuths);
      sum += rgb(f(wi, wo)) * (wo.z() * std::sin(angle) * weight * 2.0 * std::numbers::pi / azimuths);
    }
  });
  return sum;
}

/// Returns the fraction of the light from `theta_i` that is reflected outside a cone around the mirror direction, by
/// the midpoint rule of `directional_albedo`. Angles in radians.
template <brdf Brdf>
[[nodiscard]] rgb share_outside_cone(const Brdf& f, double theta_i, double half_angle, int bins = 400) {
  const direction mirror = spherical_direction(theta_i, std::numbers::pi);
  const double cosine = std::cos(half_angle);
  rgb sum = rgb::Zero();
  detail::for_each_light(theta_i, bins, [&](const direction& wi, const direction& wo, double weight) {
    if (wi.dot(mirror) < cosine) sum += rgb(f(wi, wo)) * weight;
  });
  return sum;
}

/// L*a*b* at an aspecular angle: the viewer is in the plane of incidence, at this angle from the mirror direction
/// towards the light, which is at 45 degrees. A perfect diffuser has L* 100; highlights and flakes have more.
struct aspecular_colour {
  double aspecular = 0.0;  ///< degrees
  rgb lab{0.0, 0.0, 0.0};
};

/// Returns the directions of light and viewer for an aspecular angle in degrees.
[[nodiscard]] direction_pair aspecular_directions(double aspecular);

struct instrument_readings {
  std::array<double, 3> gloss{};  ///< gloss units at 20, 60 and 85 degrees
  double haze = 0.0;              ///< `reflection_haze`
  rgb total{0.0, 0.0, 0.0};       ///< reflectance at 8 degrees into the hemisphere, specular included
  rgb diffuse{0.0, 0.0, 0.0};     ///< the same, but without 4 degrees around the mirror direction
  double scatter = 0.0;  ///< total integrated scatter at 8 degrees: the fraction of luminance outside 2.5 degrees
  std::array<aspecular_colour, 5> colours{};  ///< at 15, 25, 45, 75 and 110 degrees, as `aspecular_angles`

  /// ASTM D4039: gloss at 60 degrees minus gloss at 20 degrees.
  [[nodiscard]] double haze_index() const noexcept { return gloss[1] - gloss[0]; }
};

inline constexpr std::array<int, 3> gloss_angles{20, 60, 85};
inline constexpr std::array<double, 5> aspecular_angles{15.0, 25.0, 45.0, 75.0, 110.0};

/// Computes all readings: about 300,000 evaluations, 0.1 s for a table.
template <brdf Brdf>
[[nodiscard]] instrument_readings read_instruments(const Brdf& f) {
  instrument_readings all;
  for (std::size_t i = 0; i < gloss_angles.size(); ++i) all.gloss[i] = specular_gloss(f, gloss_angles[i]);
  all.haze = reflection_haze(f);

  // Integrating spheres.
  const double incidence = radians(8.0);
  all.diffuse = share_outside_cone(f, incidence, radians(4.0));
  all.total = all.diffuse + share_within_cone(f, incidence, radians(4.0));
  const double scattered = luminance(share_outside_cone(f, incidence, radians(2.5)));
  const double reflected = scattered + luminance(share_within_cone(f, incidence, radians(2.5)));
  all.scatter = reflected > 0.0 ? scattered / reflected : 0.0;

  // Multi-angle instruments.
  for (std::size_t i = 0; i < aspecular_angles.size(); ++i) {
    const auto [wi, wo] = aspecular_directions(aspecular_angles[i]);
    all.colours[i] = {aspecular_angles[i], to_unclipped_lab(rgb(f(wi, wo)) * std::numbers::pi)};
  }
  return all;
}

}  // namespace gonio::model

#if !defined(GONIO_COMPILED)
#include <gonio/model/impl/instrument_readings.ipp>
#endif
