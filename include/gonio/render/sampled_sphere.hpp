#pragma once
/// A sphere in an environment as a path tracer sees it: light drawn by importance of the BRDF and of the environment,
/// combined. E. Veach and L. Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering", SIGGRAPH
/// 1995 (doi:10.1145/218380.218498): the balance heuristic. Light that is reflected once is all there is on a sphere.

#include <gonio/core/parallel.hpp>
#include <gonio/core/progress.hpp>
#include <gonio/core/random.hpp>
#include <gonio/core/sampled_direction.hpp>
#include <gonio/render/environment_sampler.hpp>
#include <gonio/render/image.hpp>
#include <gonio/render/lighting.hpp>

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace gonio::render {

/// A camera at infinity in front of the sphere, as in render/sphere.hpp.
struct sampled_sphere_view {
  int size = 256;                 ///< rows and columns of the image
  int samples = 64;               ///< of the BRDF, and as many of the environment, for each pixel
  std::uint64_t seed = 1;         ///< decides all draws
  double white = 1.0;             ///< the mean luminance that a white Lambertian sphere would have
  bool shows_environment = true;  ///< around the sphere; otherwise black
};

namespace detail {

/// Pairs of numbers from 0 to 1, so many pairs of so many kinds: the pairs of a kind fill the square evenly, however
/// many there are (steps by the powers of the root of x^3 = x + 1: M. Roberts, "The Unreasonable Effectiveness of
/// Quasirandom Sequences", 2018), and which pairs of two kinds belong together is drawn at random.
class even_pairs {
 public:
  static constexpr Eigen::Index kinds = 4;
  struct pair {
    double u = 0.0, v = 0.0;
  };
  using pairs = std::array<pair, kinds>;

  even_pairs(Eigen::Index count, std::uint64_t seed, std::uint64_t stream);

  [[nodiscard]] auto begin() const noexcept { return all_.begin(); }
  [[nodiscard]] auto end() const noexcept { return all_.end(); }

 private:
  static constexpr double root = 1.324717957244746;

  [[nodiscard]] double next() { return uniform_number(generator_); }

  std::mt19937_64 generator_;
  std::vector<pairs> all_;
};

/// Light reflected by a surface towards a camera at +z: one draw by the material, one by the environment.
template <direction_sampler Sampler>
[[nodiscard]] rgb reflected_once(const Sampler& material, const environment_sampler& light,
                                 const surface_frame& surface, const even_pairs::pairs& u) {
  const direction wo = surface.to_local(direction::UnitZ());
  rgb sum = rgb::Zero();
  if (const sampled_direction drawn = material.sample(wo, u[1].u, u[1].v); (drawn.weight > 0.0).any()) {
    const direction towards = surface.to_world(drawn.wi);
    sum += drawn.weight * light.map()(towards) * (drawn.pdf / (drawn.pdf + light.pdf(towards)));
  }
  const sampled_light lamp = light.sample(u[2].u, u[2].v);
  if (const direction wi = surface.to_local(lamp.towards); wi.z() > 0.0)
    sum += rgb(material.brdf()(wi, wo)) * lamp.radiance * (wi.z() / (lamp.pdf + material.pdf(wi, wo)));
  return sum;
}

/// What the samples of a pixel, or a row of them, have seen.
struct seen_light {
  rgb sum = rgb::Zero();
  double white = 0.0;        ///< what a white Lambertian sphere would have reflected, in luminance
  Eigen::Index covered = 0;  ///< samples that saw the sphere
};

/// One sample of a pixel's square: x to the right and y upwards, from -1 to 1.
template <direction_sampler Sampler>
void add_sample(seen_light& seen, const Sampler& material, const environment_sampler& light, double x, double y,
                const even_pairs::pairs& u, bool shows_environment) {
  const double squared = x * x + y * y;
  if (squared >= 1.0) {
    if (shows_environment) seen.sum += light.map()(direction(x, y, -3.0));
    return;
  }
  const surface_frame surface({x, y, std::sqrt(1.0 - squared)});
  seen.sum += reflected_once(material, light, surface, u);
  const sampled_light lamp = light.sample(u[3].u, u[3].v);
  const double cosine = std::max(surface.normal.dot(lamp.towards), 0.0);
  seen.white += luminance(lamp.radiance) * cosine / lamp.pdf * std::numbers::inv_pi;
  ++seen.covered;
}

}  // namespace detail

/// An image of a sphere, in linear light. The environment is scaled such that a white Lambertian sphere would have the
/// mean luminance `view.white`. The material samples itself and has its BRDF as `brdf()`, such as
/// `half_vector_sampler`. Same bytes for any number of threads. O(pixels x samples).
template <direction_sampler Sampler>
[[nodiscard]] image render_sphere(const Sampler& material, const environment_sampler& light,
                                  const sampled_sphere_view& view = {}, thread_count threads = {},
                                  const progress& listener = {}) {
  GONIO_ASSERT(view.size >= 1 && view.samples >= 1);
  // Allocate the image, and a sum of light for each row.
  const Eigen::Index side = view.size;
  image picture = uniform_image(side, side, rgb::Zero());
  std::vector<detail::seen_light> rows(side);
  std::mutex reporting;
  Eigen::Index done = 0;
  // Average the samples of a pixel; each starts at a place within the pixel.
  const auto place = [side](Eigen::Index pixel, double within) {
    return (static_cast<double>(pixel) + within) / static_cast<double>(side) * 2.0 - 1.0;
  };
  const auto draw_pixel = [&](Eigen::Index row, Eigen::Index column) {
    rows[row].sum.setZero();
    for (const auto& u : detail::even_pairs(view.samples, view.seed, row * side + column))
      detail::add_sample(rows[row], material, light, place(column, u[0].u), -place(row, u[0].v), u,
                         view.shows_environment);
    set_pixel(picture, row, column, rows[row].sum / view.samples);
  };
  // Render the rows in parallel.
  for_each_block(
      side, 1,
      [&](block range) {
        for (Eigen::Index column = 0; column < side; ++column) draw_pixel(range.begin, column);
        const std::scoped_lock lock(reporting);
        report(listener, "rendering", static_cast<double>(++done) / static_cast<double>(side));
      },
      threads);
  // Scale the image such that a white sphere would have the mean luminance `view.white`.
  detail::seen_light all;
  for (const detail::seen_light& row : rows) {
    all.white += row.white;
    all.covered += row.covered;
  }
  const double exposure = all.white > 0.0 ? view.white * static_cast<double>(all.covered) / all.white : 1.0;
  for (float& value : picture) value = static_cast<float>(value * exposure);
  return picture;
}

}  // namespace gonio::render

#if !defined(GONIO_COMPILED)
#include <gonio/render/impl/sampled_sphere.ipp>
#endif
