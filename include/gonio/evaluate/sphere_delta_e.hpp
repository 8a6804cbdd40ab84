#pragma once
/// How different two BRDF tables look on a sphere, as Noell, Koehler and Stricker 2014, Sec. 3.1, judge them: the mean
/// CIELAB 1976 difference over the sphere's pixels in a natural environment, and the image of differences of
/// their Fig. 3. A difference of 1 is about what an observer just notices.

#include <gonio/render/false_colour.hpp>
#include <gonio/render/sphere.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace gonio {

/// What an observer sees of a sphere: the CIELAB colours of its points, and the exposure at which they were taken,
/// relative to one at which a white Lambertian sphere has mean luminance 1.
struct sphere_appearance {
  render::sphere_colours lab;
  double exposure = 1.0;
};

/// Renders tables over given cells under one lighting and compares the images as an observer of a display would.
///
/// Exposure: the truth's sphere is brought to a given mean luminance, before clipping and over the sphere's pixels, and
/// estimates are seen at the truth's exposure, so that one that is too bright looks too bright. The light's brightness
/// does not matter. The paper does not state its exposure; the default here is a photographer's middle grey.
/// Colours are linear Rec. 709, clipped to [0, 1], and seen under D65, so a highlight beyond white counts as white.
/// Negative reflectance counts as zero cell by cell, as in log_relative: no renderer could show it, and under an
/// environment it would darken its neighbours.
///
/// ```cpp
/// const gonio::render::environment_map grace(gonio::io::read_hdr("grace_probe_latlong.hdr"));
/// const gonio::sphere_delta_e delta_e(truth.cells(), gonio::render::important_lights(grace, 4096, 1));
/// const gonio::sphere_appearance seen = delta_e.expose(truth);  // once for each truth
/// for (const gonio::brdf_table& estimate : estimates) std::cout << delta_e.difference(estimate, seen) << '\n';
/// ```
///
/// Directional lights suit rough materials. For mirror-like ones, or all kinds, light the sphere by
/// `environment_lighting(90, 72, grace)`: more entries, but no highlight is lost between two lights.
class sphere_delta_e {
 public:
  /// The mean luminance to which a truth is exposed by default: white is 1.
  static constexpr double middle_grey = 0.18;

  /// Prepares the sphere; takes the time and memory of a `sphere_operator`. Throws gonio::error unless `mean_luminance`
  /// is positive and finite.
  template <render::sphere_lighting Lighting>
  sphere_delta_e(const valid_cells& cells, const Lighting& lighting, int size = 36, double mean_luminance = middle_grey,
                 thread_count threads = {})
      : mean_luminance_(checked(mean_luminance)), sphere_(cells, lighting, size, threads) {}

  [[nodiscard]] const valid_cells& cells() const noexcept { return sphere_.cells(); }

  /// The sphere's linear colours before exposure and clipping.
  [[nodiscard]] const render::sphere_operator& sphere() const noexcept { return sphere_; }

  /// What an observer sees of a truth, at its own exposure. A black sphere, which no exposure brightens, is seen at
  /// exposure 1. Throws gonio::error if the table is over other cells.
  [[nodiscard]] sphere_appearance expose(const brdf_table& truth, thread_count threads = {}) const;

  /// What an observer sees of a table at a given exposure. Throws gonio::error if the table is over other cells.
  [[nodiscard]] sphere_appearance look(const brdf_table& table, double exposure, thread_count threads = {}) const;

  /// Delta E*ab (CIE 1976) at each of the sphere's points between two appearances of the same sphere.
  [[nodiscard]] static Eigen::ArrayXd differences(const sphere_appearance& a, const sphere_appearance& b);

  /// Mean Delta E*ab over the sphere's points.
  [[nodiscard]] static double difference(const sphere_appearance& a, const sphere_appearance& b);

  /// Mean Delta E*ab of an estimate, seen at the truth's exposure: keep a truth's appearance to compare many estimates
  /// with it.
  [[nodiscard]] double difference(const brdf_table& estimate, const sphere_appearance& truth,
                                  thread_count threads = {}) const {
    return difference(look(estimate, truth.exposure, threads), truth);
  }

  [[nodiscard]] double difference(const brdf_table& estimate, const brdf_table& truth,
                                  thread_count threads = {}) const {
    return difference(estimate, expose(truth, threads), threads);
  }

  /// The image of differences of the paper's Fig. 3: each point in the false colour of its Delta E*ab.
  [[nodiscard]] image difference_image(const sphere_appearance& a, const sphere_appearance& b,
                                       const render::false_colour_range& range = {},
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
