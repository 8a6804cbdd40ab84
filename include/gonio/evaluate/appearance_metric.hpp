#pragma once
/// The visible difference of two BRDF tables: the mean CIELAB 1976 difference over the pixels of a sphere, under two
/// directional lights and under an environment (render/lighting.hpp). An observer just notices a difference of about 1.

#include <gonio/evaluate/sphere_delta_e.hpp>

namespace gonio {

struct appearance {
  sphere_appearance lights;
  sphere_appearance environment;
};

/// Mean Delta E*ab (CIE 1976) over the sphere's pixels.
struct appearance_difference {
  double lights = 0.0;
  double environment = 0.0;
};

/// Renders tables over given cells and compares the images as an observer of a display would. Uses a `sphere_delta_e`
/// for each lighting, but with the same exposure for every table: the exposure at which a white Lambertian sphere has
/// mean luminance 1.
class appearance_metric {
 public:
  /// Prepares the spheres. Needs the time and memory of two `sphere_operator`s.
  explicit appearance_metric(const valid_cells& cells, int size = 36, thread_count threads = {});

  [[nodiscard]] const valid_cells& cells() const noexcept { return lights_.cells(); }

  /// Return the operators of the two lightings. An operator gives a sphere's linear colours before clipping.
  [[nodiscard]] const render::sphere_operator& lights() const noexcept { return lights_.sphere(); }
  [[nodiscard]] const render::sphere_operator& environment() const noexcept { return environment_.sphere(); }

  /// Returns the appearance of a table. Throws gonio::error if it is over other cells.
  [[nodiscard]] appearance look(const brdf_table& table, thread_count threads = {}) const;

  /// Returns the mean difference between two appearances computed by the same metric. To compare many estimates with
  /// one truth, compute the truth's appearance once and reuse it.
  [[nodiscard]] static appearance_difference difference(const appearance& a, const appearance& b) {
    return {sphere_delta_e::difference(a.lights, b.lights), sphere_delta_e::difference(a.environment, b.environment)};
  }

  [[nodiscard]] appearance_difference difference(const brdf_table& a, const brdf_table& b,
                                                 thread_count threads = {}) const {
    return difference(look(a, threads), look(b, threads));
  }

 private:
  sphere_delta_e lights_;
  sphere_delta_e environment_;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/evaluate/impl/appearance_metric.ipp>
#endif
