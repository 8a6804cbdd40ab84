#pragma once
/// The visible difference of two BRDF tables on a sphere, as in Noell, Koehler and Stricker 2014, section 3.1: the mean
/// CIELAB 1976 difference over the sphere's pixels in a natural environment, and the paper's image of differences (Fig.
/// 3). An observer just notices a difference of about 1.

#include <gonio/render/false_colour.hpp>
#include <gonio/render/sphere.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace gonio {

/// The appearance of a sphere: the CIELAB colours of its points, and its exposure. At exposure 1, a white Lambertian
/// sphere has mean luminance 1.
struct sphere_appearance {
  render::sphere_colours lab;
  double exposure = 1.0;
};

/// Renders tables over given cells under one lighting and compares the images as an observer of a display would.
///
/// Exposure: the truth's sphere is scaled to a given mean luminance over its pixels, before clipping, so the light's
/// brightness does not matter. Estimates use the truth's exposure, so an estimate that is too bright looks too bright.
/// The paper does not state its exposure; the default is a photographer's middle grey. Colours are linear Rec. 709,
/// clipped to [0, 1], seen under D65, so a highlight above white counts as white. Negative reflectance counts as zero
/// in each cell, as in log_relative: no renderer can show it, and under an environment it would cancel the light of
/// other cells.
///
/// ```cpp
/// const gonio::render::environment_map grace(gonio::io::read_hdr("grace_probe_latlong.hdr"));
/// const gonio::sphere_delta_e delta_e(truth.cells(), gonio::render::important_lights(grace, 4096, 1));
/// const gonio::sphere_appearance seen = delta_e.expose(truth);  // once for each truth
/// for (const gonio::brdf_table& estimate : estimates) std::cout << delta_e.difference(estimate, seen) << '\n';
/// ```
///
/// Directional lights suit rough materials. For mirror-like or mixed materials, use `environment_lighting(90, 72,
/// grace)`: it costs more entries, but misses no highlight between two lights.
class sphere_delta_e {
 public:
  /// The default mean luminance of an exposed truth; white is 1.
  static constexpr double middle_grey = 0.18;

  /// Prepares the sphere. Needs the time and memory of a `sphere_operator`. Throws gonio::error unless `mean_luminance`
  /// is positive and finite.
  template <render::sphere_lighting Lighting>
  sphere_delta_e(const valid_cells& cells, const Lighting& lighting, int size = 36, double mean_luminance = middle_grey,
                 thread_count threads = {})
      : mean_luminance_(checked(mean_luminance)), sphere_(cells, lighting, size, threads) {}

  [[nodiscard]] const valid_cells& cells() const noexcept { return sphere_.cells(); }

  /// Returns the sphere's operator, which gives linear colours before exposure and clipping.
  [[nodiscard]] const render::sphere_operator& sphere() const noexcept { return sphere_; }

  /// Returns the appearance of a truth at its own exposure (1 for a black sphere). Throws gonio::error if the table is
  /// over other cells.
  [[nodiscard]] sphere_appearance expose(const brdf_table& truth, thread_count threads = {}) const;

  /// Returns the appearance of a table at a given exposure. Throws gonio::error if the table is over other cells.
  [[nodiscard]] sphere_appearance look(const brdf_table& table, double exposure, thread_count threads = {}) const;

  /// Returns Delta E*ab (CIE 1976) at each of the sphere's points between two appearances of the same sphere.
  [[nodiscard]] static Eigen::ArrayXd differences(const sphere_appearance& a, const sphere_appearance& b);

  /// Returns the mean Delta E*ab over the sphere's points.
  [[nodiscard]] static double difference(const sphere_appearance& a, const sphere_appearance& b);

  /// Returns the mean Delta E*ab of an estimate at the truth's exposure. To compare many estimates with a truth, keep
  /// the truth's appearance.
  [[nodiscard]] double difference(const brdf_table& estimate, const sphere_appearance& truth,
                                  thread_count threads = {}) const {
    return difference(look(estimate, truth.exposure, threads), truth);
  }

  [[nodiscard]] double difference(const brdf_table& estimate, const brdf_table& truth,
                                  thread_count threads = {}) const {
    return difference(estimate, expose(truth, threads), threads);
  }

  /// Returns the image of differences of the paper's Fig. 3: each point in the colour of its Delta E*ab
  /// (`render::difference_colour`), darkest where Delta E*ab is at least `largest`.
  [[nodiscard]] image difference_image(const sphere_appearance& a, const sphere_appearance& b, double largest = 20.0,
                                       const rgb& background = rgb::Zero()) const;

 private:
  [[nodiscard]] static double checked(double mean_luminance);

  [[nodiscard]] render::sphere_colours visible_colours(const brdf_table& table, thread_count threads) const;

  [[nodiscard]] static sphere_appearance seen_at(double exposure, const render::sphere_colours& colours);

  double mean_luminance_;
  render::sphere_operator sphere_;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/evaluate/impl/sphere_delta_e.ipp>
#endif
