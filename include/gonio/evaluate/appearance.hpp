#pragma once
/// How different two BRDF tables look: the mean CIELAB 1976 difference over the pixels of a sphere, under two
/// directional lights and under an environment (render/lighting.hpp). A difference of 1 is about what an observer
/// just notices.

#include <gonio/render/sphere.hpp>

namespace gonio {

/// CIELAB colours of the points of a sphere under both lightings.
struct appearance {
  sphere_colours lights;
  sphere_colours environment;
};

/// Mean Delta E*ab (CIE 1976) over the sphere's pixels.
struct appearance_difference {
  double lights = 0.0;
  double environment = 0.0;
};

/// Renders tables over given cells and compares the pictures as an observer of a display would.
///
/// Exposure: a white Lambertian sphere has mean luminance 1. Colours are linear Rec. 709, clipped to [0, 1], and
/// seen under D65, so a highlight beyond white counts as white. Negative reflectance counts as zero cell by cell,
/// as in log_relative: no renderer could show it, and under an environment it would darken its neighbours.
class appearance_judge {
 public:
  /// Prepares the spheres; takes the time and memory of two `sphere_operator`s.
  explicit appearance_judge(const valid_cells& cells, int size = 36, thread_count threads = {})
      : lights_(cells, two_lights(), size, threads), environment_(cells, environment_lighting(), size, threads) {}

  [[nodiscard]] const valid_cells& cells() const noexcept { return lights_.cells(); }

  /// The spheres' linear colours before clipping, as the operators of both lightings.
  [[nodiscard]] const sphere_operator& lights() const noexcept { return lights_; }
  [[nodiscard]] const sphere_operator& environment() const noexcept { return environment_; }

  /// What an observer sees of a table. Throws gonio::error if it is over other cells.
  [[nodiscard]] appearance look(const brdf_table& table, thread_count threads = {}) const {
    const auto negative = [](float value) { return value < 0.0f; };
    if (std::ranges::none_of(table.values(), negative))
      return {lab_of(lights_.apply(table, threads)), lab_of(environment_.apply(table, threads))};
    brdf_table clamped = table;
    std::ranges::replace_if(clamped.values(), negative, 0.0f);
    return look(clamped, threads);
  }

  /// Mean difference of two appearances of the same judge: keep a truth's to compare many estimates with it.
  [[nodiscard]] static appearance_difference difference(const appearance& a, const appearance& b) {
    const auto mean_distance = [](const sphere_colours& p, const sphere_colours& q) {
      GONIO_ASSERT(p.rows() == q.rows());
      return (p - q).matrix().rowwise().norm().mean();
    };
    return {mean_distance(a.lights, b.lights), mean_distance(a.environment, b.environment)};
  }

  [[nodiscard]] appearance_difference difference(const brdf_table& a, const brdf_table& b,
                                                 thread_count threads = {}) const {
    return difference(look(a, threads), look(b, threads));
  }

 private:
  [[nodiscard]] static sphere_colours lab_of(const sphere_colours& colours) {
    sphere_colours lab(colours.rows(), 3);
    for (Eigen::Index point = 0; point < colours.rows(); ++point)
      lab.row(point) = to_lab(colours.row(point).transpose()).transpose();
    return lab;
  }

  sphere_operator lights_;
  sphere_operator environment_;
};

}  // namespace gonio
