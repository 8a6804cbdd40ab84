#pragma once
/// Sampling densities in closed form, and the choice of densities for each lobe. B. Walter, "Notes on the Ward BRDF",
/// Cornell PCG-05-06, 2005 (Gaussian slopes); B. Walter, S. R. Marschner, H. Li and K. E. Torrance, EGSR 2007
/// (doi:10.2312/EGWR/EGSR07/195-206), Eq. 14 (reflected half vectors); E. Heitz, "Sampling the GGX Distribution of
/// Visible Normals", JCGT 2018; J. Dupuy and A. Benyoub, "Sampling Visible GGX Normals with Spherical Caps", HPG 2023
/// (doi:10.1111/cgf.14867); E. P. F. Lafortune, S.-C. Foo, K. E. Torrance and D. P. Greenberg, "Non-Linear
/// Approximation of Reflectance Functions", SIGGRAPH 1997 (doi:10.1145/258734.258801; cosine lobes).

#include <gonio/core/sampled_direction.hpp>
#include <gonio/model/analytic_brdf.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <variant>
#include <vector>

namespace gonio::model {

// ---- densities of directions: each draws wi given wo above the horizon, and returns its density in sr^-1 ---------

namespace detail {

/// Returns the polar angle within which the density (exponent + 1) / (2 pi) cos^exponent has the integral u. Accurate
/// for large exponents, whose cosines are all near 1.
[[nodiscard]] inline double power_cosine_angle(double exponent, double u) noexcept {
  const double log_cosine = std::log1p(-u) / (exponent + 1.0);
  return std::atan2(std::sqrt(-std::expm1(2.0 * log_cosine)), std::exp(log_cosine));
}

[[nodiscard]] inline double power_cosine_density(double exponent, double cosine) noexcept {
  return (exponent + 1.0) * (0.5 * std::numbers::inv_pi) * cosine_power(cosine, exponent);
}

[[nodiscard]] inline direction reflected(const direction& wo, const direction& h) noexcept {
  return (2.0 * wo.dot(h) * h - wo).normalized();
}

/// Returns the density of wi, given the density of its half vector above the horizon: dh / d wi = 1 / (4 |wo . h|), and
/// |wo . h| is half the length of wi + wo. Returns 0 if wi is opposite to wo, where many half vectors reflect wo to wi.
template <class Density>
[[nodiscard]] double reflected_density(const direction& wi, const direction& wo, const Density& of_half) noexcept {
  const direction sum = wi + wo;
  const double length = sum.norm();
  if (!(length > 0.0 && sum.z() != 0.0)) return 0.0;
  return of_half(direction(sum / std::copysign(length, sum.z()))) / (2.0 * length);
}

}  // namespace detail

/// Draws directions with the density cos(theta_i) / pi.
struct cosine_directions {
  [[nodiscard]] direction sample(const direction& /*wo*/, double u1, double u2) const noexcept {
    return cosine_weighted_direction(u1, u2);
  }
  [[nodiscard]] double pdf(const direction& wi, const direction& /*wo*/) const noexcept {
    return cosine_weighted_pdf(wi);
  }
};

/// Draws directions with the density (n + 1) / (2 pi) cos^n of the angle to M wo, where M = diag(tangential,
/// tangential, normal): Phong's lobe about the mirror direction, and Lafortune's lobe.
struct power_cosine_directions {
  double exponent = 1.0;                   ///< n
  double tangential = -1.0, normal = 1.0;  ///< the diagonal of M; the default gives the mirror direction

  [[nodiscard]] direction sample(const direction& wo, double u1, double u2) const noexcept {
    return turned(axis(wo), detail::power_cosine_angle(exponent, u1), 2.0 * std::numbers::pi * u2);
  }
  [[nodiscard]] double pdf(const direction& wi, const direction& wo) const noexcept {
    return detail::power_cosine_density(exponent, wi.dot(axis(wo)));
  }

 private:
  [[nodiscard]] direction axis(const direction& wo) const noexcept {
    const direction m(tangential * wo.x(), tangential * wo.y(), normal * wo.z());
    const double length = m.norm();
    return length > 0.0 ? direction(m / length) : direction(0.0, 0.0, 1.0);
  }
};

/// Draws half vectors with the density (n + 1) / (2 pi) (h . n)^n of Blinn-Phong.
struct power_cosine_half_vectors {
  double exponent = 1.0;

  [[nodiscard]] direction sample(const direction& wo, double u1, double u2) const noexcept {
    return detail::reflected(
        wo, spherical_direction(detail::power_cosine_angle(exponent, u1), 2.0 * std::numbers::pi * u2));
  }
  [[nodiscard]] double pdf(const direction& wi, const direction& wo) const noexcept {
    return detail::reflected_density(wi, wo,
                                     [&](const direction& h) { return detail::power_cosine_density(exponent, h.z()); });
  }
};

/// Draws half vectors with Gaussian slopes: the density is exp(-((h_x / alpha_x)^2 + (h_y / alpha_y)^2) / h_z^2) / (pi
/// alpha_x alpha_y h_z^3). Walter 2005. If alpha_x = alpha_y, it is Beckmann's distribution times the cosine.
struct gaussian_half_vectors {
  double alpha_x = 0.2, alpha_y = 0.2;
  double rotation = 0.0;  ///< azimuth of the axis of alpha_x in radians

  [[nodiscard]] direction sample(const direction& wo, double u1, double u2) const noexcept {
    const double radius = std::sqrt(-std::log1p(-u1)), angle = 2.0 * std::numbers::pi * u2;
    const direction h(alpha_x * radius * std::cos(angle), alpha_y * radius * std::sin(angle), 1.0);
    return detail::reflected(wo, turned_about_normal(h.normalized(), rotation));
  }
  [[nodiscard]] double pdf(const direction& wi, const direction& wo) const noexcept {
    return detail::reflected_density(wi, wo, [&](const direction& h) {
      const direction own = turned_about_normal(h, -rotation);
      const double x = own.x() / (h.z() * alpha_x), y = own.y() / (h.z() * alpha_y), exponent = x * x + y * y;
      if (!(exponent < 700.0)) return 0.0;
      return std::exp(-exponent) * std::numbers::inv_pi / (alpha_x * alpha_y * h.z() * h.z() * h.z());
    });
  }
};

/// Draws half vectors among the GGX facets visible from wo, with the density G1(wo) D(h) max(wo . h, 0) / cos(theta_o).
/// Heitz 2018, sampled as in Dupuy and Benyoub 2023.
struct ggx_visible_normals {
  double alpha_x = 0.2, alpha_y = 0.2;
  double rotation = 0.0;  ///< azimuth of the axis of alpha_x in radians

  [[nodiscard]] direction sample(const direction& wo, double u1, double u2) const noexcept {
    // Stretch the viewer's direction so that the visible facets become a hemisphere.
    const direction own = turned_about_normal(wo, -rotation);
    const direction seen = direction(alpha_x * own.x(), alpha_y * own.y(), own.z()).normalized();
    // Directions reflected by the hemisphere fill a spherical cap uniformly. Draw such a direction, take its half
    // vector, and undo the stretching.
    const double z = (1.0 - u1) * (1.0 + seen.z()) - seen.z(), azimuth = 2.0 * std::numbers::pi * u2;
    const double sine = std::sqrt(std::max(0.0, 1.0 - z * z));
    const direction half = direction(sine * std::cos(azimuth), sine * std::sin(azimuth), z) + seen;
    const direction h = direction(alpha_x * half.x(), alpha_y * half.y(), half.z()).normalized();
    return detail::reflected(wo, turned_about_normal(h, rotation));
  }
  [[nodiscard]] double pdf(const direction& wi, const direction& wo) const noexcept {
    // The factor wo . h of the facets' density and the factor 1 / (wo . h) of the reflection cancel.
    const direction sum = wi + wo;
    if (!(sum.z() > 0.0)) return 0.0;
    if (alpha_x == alpha_y)
      return 0.5 * detail::ggx_distribution(sum.normalized(), alpha_x) *
             detail::ggx_masking_over_twice_cosine(wo.z(), alpha_x);
    const anisotropic_ggx_shape<double> facets{.alpha_x = alpha_x, .alpha_y = alpha_y, .rotation = rotation};
    return 0.5 * facets.distribution(sum.normalized()) * facets.masking_over_twice_cosine(wo.z(), wo.x(), wo.y());
  }
};

// ---- the densities of each lobe ----------------------------------------------------------------------------------

/// A density, and the fraction of a lobe's directions drawn from it.
struct sampling_technique {
  using density_type = std::variant<cosine_directions, power_cosine_directions, power_cosine_half_vectors,
                                    gaussian_half_vectors, ggx_visible_normals>;
  density_type density;
  double share = 1.0;
};

/// A lobe's densities, whose shares sum to 1. For a shape of your own, define `techniques_of(shape)` in its namespace.
using sampling_techniques = std::vector<sampling_technique>;

namespace detail {

/// The share of cosine-weighted directions for a lobe whose weights are otherwise unbounded. With this share, no weight
/// exceeds 10 pi f.
inline constexpr double defensive_share = 0.1;

/// Adds cosine-weighted directions with the share 1 / (1 + exponent), because a wide lobe is nearly diffuse.
[[nodiscard]] sampling_techniques with_cosine_if_wide(const sampling_technique::density_type& density, double exponent);

/// With Gaussian slopes, the weight of Ward's lobe is (wo . h) h_z^3 sqrt(cos theta_i / cos theta_o) (Walter 2005). The
/// weight of Ward-Duer's lobe has 1 / cos theta_o instead of the root. Both weights grow without bound towards grazing
/// viewers.
[[nodiscard]] inline sampling_techniques ward_techniques(double alpha_x, double alpha_y, double rotation = 0.0) {
  return {{gaussian_half_vectors{alpha_x, alpha_y, rotation}, 1.0 - defensive_share},
          {cosine_directions{}, defensive_share}};
}

}  // namespace detail

[[nodiscard]] inline sampling_techniques techniques_of(const lambertian& /*f*/) { return {{cosine_directions{}, 1.0}}; }
[[nodiscard]] inline sampling_techniques techniques_of(const lambert_shape<double>& /*shape*/) {
  return {{cosine_directions{}, 1.0}};
}

[[nodiscard]] inline sampling_techniques techniques_of(const phong::shape_type& shape) {
  return detail::with_cosine_if_wide(power_cosine_directions{.exponent = shape.shininess}, shape.shininess);
}
[[nodiscard]] inline sampling_techniques techniques_of(const blinn_phong::shape_type& shape) {
  return detail::with_cosine_if_wide(power_cosine_half_vectors{shape.shininess}, shape.shininess);
}
/// Powers are convex: ((1 - alpha) a + alpha b)^s <= (1 - alpha) a^s + alpha b^s for s >= 1. A mixture of Phong's and
/// Blinn-Phong's directions therefore bounds the weights.
[[nodiscard]] sampling_techniques techniques_of(const phong_blinn::shape_type& shape);
[[nodiscard]] sampling_techniques techniques_of(const lafortune::shape_type& shape);

[[nodiscard]] inline sampling_techniques techniques_of(const ward::shape_type& shape) {
  return detail::ward_techniques(shape.roughness, shape.roughness);
}
[[nodiscard]] inline sampling_techniques techniques_of(const ward_duer::shape_type& shape) {
  return detail::ward_techniques(shape.roughness, shape.roughness);
}
[[nodiscard]] inline sampling_techniques techniques_of(const anisotropic_ward::shape_type& shape) {
  return detail::ward_techniques(shape.roughness_x, shape.roughness_y, shape.rotation);
}
[[nodiscard]] inline sampling_techniques techniques_of(const anisotropic_ward_duer::shape_type& shape) {
  return detail::ward_techniques(shape.roughness_x, shape.roughness_y, shape.rotation);
}
/// The weight is cos theta_i / ((wo . h) h_z). It is at most 2, because 2 (wo . h) h_z = cos theta_i + cos theta_o.
[[nodiscard]] inline sampling_techniques techniques_of(const ward_bounded::shape_type& shape) {
  return {{gaussian_half_vectors{shape.roughness, shape.roughness}, 1.0}};
}
[[nodiscard]] inline sampling_techniques techniques_of(const anisotropic_ward_bounded::shape_type& shape) {
  return {{gaussian_half_vectors{shape.roughness_x, shape.roughness_y, shape.rotation}, 1.0}};
}

/// The weight is F min((wo . h) / (cos theta_o h_z), 2 cos theta_i / max(cos theta_i, cos theta_o)). It is at most 2.
[[nodiscard]] inline sampling_techniques techniques_of(const torrance_sparrow::shape_type& shape) {
  return {{gaussian_half_vectors{shape.slope, shape.slope}, 1.0}};
}
/// The weight is F G1(wi). It is at most 1.
[[nodiscard]] inline sampling_techniques techniques_of(const ggx& f) {
  return {{ggx_visible_normals{f.alpha, f.alpha}, 1.0}};
}
[[nodiscard]] inline sampling_techniques techniques_of(const ggx_lobe::shape_type& shape) {
  return {{ggx_visible_normals{shape.alpha, shape.alpha}, 1.0}};
}
[[nodiscard]] inline sampling_techniques techniques_of(const anisotropic_ggx::shape_type& shape) {
  return {{ggx_visible_normals{shape.alpha_x, shape.alpha_y, shape.rotation}, 1.0}};
}

/// Returns, for a shape times a Fresnel factor, the techniques of the shape.
template <class Shape>
requires requires(const Shape& shape) {
  techniques_of(shape.lobe);
  shape.refractive_index;
}
[[nodiscard]] sampling_techniques techniques_of(const Shape& shape) { return techniques_of(shape.lobe); }

template <template <class> class Shape>
[[nodiscard]] sampling_techniques techniques_of(const lobe<Shape>& f) {
  return techniques_of(f.shape());
}

namespace detail {

/// If the lobe has this shape, writes the shape's techniques to `taken` and returns true.
template <template <class> class Shape>
[[nodiscard]] bool take_if_same(const analytic_lobe& f, sampling_techniques& taken) {
  if (f.kind().name() != Shape<double>::name) return false;
  std::array<double, parameter_count<Shape>> own{};
  std::copy_n(f.parameters().begin(), own.size(), own.begin());
  taken = techniques_of(shape_from<Shape, double>(own));
  return true;
}

template <template <class> class... Shapes>
[[nodiscard]] sampling_techniques techniques_among(const analytic_lobe& f) {
  sampling_techniques taken{{cosine_directions{}, 1.0}};
  static_cast<void>((take_if_same<Shapes>(f, taken) || ...));
  return taken;
}

}  // namespace detail

/// Returns the techniques of a lobe, chosen by the name of its kind. For a kind outside this library, returns
/// cosine-weighted directions, which are unbiased but noisy at the lobe's highlight.
[[nodiscard]] sampling_techniques techniques_of(const analytic_lobe& f);

}  // namespace gonio::model

#if !defined(GONIO_COMPILED)
#include <gonio/model/impl/sampling_techniques.ipp>
#endif
