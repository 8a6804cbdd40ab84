#pragma once
/// Light on a sphere: two directional lights (J. B. Nielsen's thesis, 2016, Sec. 4.2: an oblique light in front, a
/// grazing light behind), and environments integrated over the half vector.
///
/// World axes: x to the right, y up, z towards a camera at infinity. The sum of f * weight over all incident directions
/// of a lighting is the radiance towards the camera: the reflected part of the rendering equation (thesis, Eq. 2.7).

#include <gonio/core/assertion.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/directional_light.hpp>
#include <gonio/core/rgb.hpp>
#include <gonio/table/grid.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <numbers>
#include <type_traits>
#include <utility>
#include <vector>

namespace gonio::render {

/// A right-handed orthonormal frame whose z axis is a surface normal.
struct surface_frame {
  explicit surface_frame(const direction& surface_normal) noexcept
      : bitangent(surface_normal.cross(std::abs(surface_normal.x()) < 0.9 ? direction::UnitX() : direction::UnitY())
                      .normalized()),
        tangent(bitangent.cross(surface_normal)),
        normal(surface_normal) {}

  /// Returns the frame whose tangent runs about an axis, as grooves do on a turned part. At the poles it is arbitrary.
  [[nodiscard]] static surface_frame around(const direction& axis, const direction& surface_normal) noexcept {
    surface_frame frame(surface_normal);
    const direction along = axis.cross(surface_normal);
    if (!(along.squaredNorm() > 1e-20)) return frame;
    frame.tangent = along.normalized();
    frame.bitangent = surface_normal.cross(frame.tangent);
    return frame;
  }

  [[nodiscard]] direction to_local(const direction& world) const noexcept {
    return {tangent.dot(world), bitangent.dot(world), normal.dot(world)};
  }
  [[nodiscard]] direction to_world(const direction& local) const noexcept {
    return local.x() * tangent + local.y() * bitangent + local.z() * normal;
  }

  direction bitangent;
  direction tangent;
  direction normal;
};

/// Incident light at a point of a sphere seen from the direction +z.
///
/// `for_each_incident(normal, visit)` calls `visit(wi, wo, weight)` for every direction of incident light. A model must
/// keep rules that the compiler cannot check:
/// - wi (towards the light) and wo (towards the camera) are unit vectors in surface_frame{normal}, both above the
///   horizon;
/// - weight is incident radiance * cos(theta_i) * solid angle, one value per colour channel, not negative;
/// - the calls depend only on the normal and always come in the same order, and the function is thread-safe.
///
/// With a model of the library:
/// ```cpp
/// #include <gonio/model/formula_materials.hpp>
/// #include <gonio/render/sphere.hpp>
///
/// #include <cstdio>
///
/// int main() {
///   const auto paint = gonio::model::formula_material("red-paint");
///   const gonio::image seen = gonio::render::render_sphere(paint, gonio::render::two_lights());
///   std::printf("%g in the middle\n", gonio::pixel(seen, 128, 128).x());
/// }
/// ```
/// With a model of your own, a headlight:
/// ```cpp
/// #include <gonio/model/lambert.hpp>
/// #include <gonio/render/sphere.hpp>
///
/// #include <cstdio>
///
/// struct headlight {
///   template <class Visit>
///   void for_each_incident(const gonio::direction& normal, Visit&& visit) const {
///     const gonio::direction wo = gonio::render::surface_frame(normal).to_local({0.0, 0.0, 1.0});
///     if (wo.z() > 0.0) visit(wo, wo, gonio::rgb(gonio::rgb::Constant(wo.z())));
///   }
/// };
/// static_assert(gonio::render::sphere_lighting<headlight>);
///
/// int main() {
///   const gonio::image seen = gonio::render::render_sphere(gonio::model::lambertian{}, headlight{});
///   std::printf("%g in the middle\n", gonio::pixel(seen, 128, 128).x());
/// }
/// ```
template <class Lighting>
concept sphere_lighting = requires(const Lighting& lighting, const direction& normal,
                                   void (&visit)(const direction&, const direction&, const rgb&)) {
  lighting.for_each_incident(normal, visit);
};

/// Any number of directional lights in world axes. Their directions may have any length.
class directional_lighting {
 public:
  explicit directional_lighting(std::vector<directional_light> lights) : lights_(std::move(lights)) {
    for (directional_light& light : lights_) light.towards.normalize();
  }

  /// Returns the lights, with directions of unit length.
  [[nodiscard]] const std::vector<directional_light>& lights() const noexcept { return lights_; }

  template <class Visit>
  void for_each_incident(const direction& normal, Visit&& visit) const {
    const surface_frame frame(normal);
    const direction wo = frame.to_local(direction::UnitZ());
    if (!(wo.z() > 0.0)) return;
    for (const directional_light& light : lights_) {
      const direction wi = frame.to_local(light.towards);
      if (wi.z() > 0.0) visit(wi, wo, rgb(light.irradiance * wi.z()));
    }
  }

 private:
  std::vector<directional_light> lights_;
};

static_assert(sphere_lighting<directional_lighting>);

/// Returns the thesis's lights: from [1, 1, 1] in front, and from [-1, -1, -3] behind the sphere. The camera sees the
/// second light's reflection only at grazing angles, on the lower left rim. Both lights are white and have irradiance
/// 1.
[[nodiscard]] inline directional_lighting two_lights() {
  return directional_lighting({{{1.0, 1.0, 1.0}}, {{-1.0, -1.0, -3.0}}});
}

/// Returns the radiance from direction `d` (a unit vector in world axes, y up) of an environment given by a formula: a
/// sky gradient, brownish ground, and six soft windows, two of them behind the sphere. It is not from a paper. This
/// project measures its colour differences under it, so it must not change.
[[nodiscard]] inline rgb environment_radiance(const direction& d) noexcept {
  struct window {
    direction centre;
    double width;  // radians from the centre at which the radiance falls to 1/e
    rgb radiance;
    double cosine_of_edge;
  };
  static const auto windows = [] {
    const auto make = [](const direction& towards, double width, double intensity, const rgb& colour) {
      // At 2.6 widths, exp(-x^4) is 1e-20, which double precision loses when the sky is added.
      return window{towards.normalized(), radians(width), intensity * colour, std::cos(radians(2.6 * width))};
    };
    return std::array{make({-0.5, 0.55, 0.67}, 6.0, 40.0, {1.0, 0.82, 0.55}),
                      make({0.75, 0.45, 0.48}, 5.0, 55.0, {1.0, 0.75, 0.45}),
                      make({0.1, 0.95, 0.30}, 8.0, 25.0, {1.0, 0.90, 0.70}),
                      make({-0.85, 0.2, -0.48}, 7.0, 60.0, {1.0, 0.80, 0.50}),
                      make({0.55, -0.15, -0.82}, 6.0, 60.0, {0.9, 0.85, 0.80}),
                      make({0.3, -0.6, 0.74}, 4.0, 15.0, {0.6, 0.75, 1.00})};
  }();

  const rgb horizon(0.55, 0.58, 0.60), zenith(0.20, 0.32, 0.60), ground(0.22, 0.17, 0.12);
  const double height = std::sqrt(std::min(std::abs(d.y()), 1.0));
  rgb radiance = horizon + (d.y() >= 0.0 ? zenith - horizon : ground - horizon) * height;
  for (const window& w : windows) {
    const double cosine = w.centre.dot(d);
    if (cosine < w.cosine_of_edge) continue;
    const double x = std::atan2(w.centre.cross(d).norm(), cosine) / w.width;
    radiance += w.radiance * std::exp(-x * x * x * x);
  }
  return radiance;
}

/// `environment_radiance` as an object.
struct formula_environment {
  [[nodiscard]] rgb operator()(const direction& d) const noexcept { return environment_radiance(d); }
};

/// Light from all directions, integrated over the half vector. Bins have equal steps in sqrt(theta_h) (MERL's warp,
/// dense at highlights) and in phi_h, with exact solid angles dw_h. Each bin stands for dw_i = 4 cos(theta_d) dw_h of
/// incident directions.
///
/// A light narrower than a bin (5 degrees in phi_h by default) gives rings on matte spheres. `Radiance` is any
/// `rgb(const direction&)` over world directions that is safe to call concurrently.
template <class Radiance = formula_environment>
requires std::is_invocable_r_v<rgb, const Radiance&, const direction&>
class environment_lighting {
 public:
  explicit environment_lighting(int theta_h_bins = 90, int phi_h_bins = 72, Radiance radiance = {})
      : radiance_(std::move(radiance)) {
    GONIO_ASSERT(theta_h_bins >= 1 && phi_h_bins >= 1);
    const grid nodes({theta_h_bins, 1, 1}, cell_anchor::centre);
    bins_.reserve(theta_h_bins * phi_h_bins);
    const double phi_step = 2.0 * std::numbers::pi / phi_h_bins;
    for (int i = 0; i < theta_h_bins; ++i) {
      const double ring = std::cos(nodes.theta_h(i - 0.5)) - std::cos(nodes.theta_h(i + 0.5));
      for (int k = 0; k < phi_h_bins; ++k)
        bins_.push_back({spherical_direction(nodes.theta_h(i), (k + 0.5) * phi_step), ring * phi_step});
    }
  }

  template <class Visit>
  void for_each_incident(const direction& normal, Visit&& visit) const {
    const surface_frame frame(normal);
    const direction wo = frame.to_local(direction::UnitZ());
    if (!(wo.z() > 0.0)) return;
    for (const bin& half : bins_) {
      // Mirror wo at the half vector.
      const double cos_theta_d = half.centre.dot(wo);
      const direction wi = 2.0 * cos_theta_d * half.centre - wo;
      if (!(cos_theta_d > 0.0 && wi.z() > 0.0)) continue;
      const double weight = 4.0 * cos_theta_d * half.solid_angle * wi.z();
      visit(wi, wo, rgb(rgb(radiance_(frame.to_world(wi))) * weight));
    }
  }

 private:
  struct bin {
    direction centre;
    double solid_angle;
  };

  Radiance radiance_;
  std::vector<bin> bins_;
};

static_assert(sphere_lighting<environment_lighting<>>);

}  // namespace gonio::render
