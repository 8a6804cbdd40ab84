#pragma once
/// Renders a sphere in an environment like a path tracer: combines importance sampling of the BRDF and of the
/// environment. E. Veach and L. Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering", SIGGRAPH
/// 1995 (doi:10.1145/218380.218498): the balance heuristic. A sphere reflects light only once.

#include <gonio/core/parallel.hpp>
#include <gonio/core/progress.hpp>
#include <gonio/core/random.hpp>
#include <gonio/core/sampled_direction.hpp>
#include <gonio/render/environment_sampler.hpp>
#include <gonio/render/image.hpp>
#include <gonio/render/lighting.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <numbers>
#include <random>

namespace gonio::render {

/// A camera at infinity in front of the sphere, as in render/sphere.hpp.
struct sampled_sphere_view {
  int size = 256;                 ///< rows and columns of the image
  int samples = 64;               ///< half the number of directions per pixel
  std::uint64_t seed = 1;         ///< determines all draws
  double white = 1.0;             ///< the mean luminance that a white Lambertian sphere would have
  bool shows_environment = true;  ///< shows the environment around the sphere; otherwise black
  bool is_turned = false;         ///< see `sphere_view::is_turned`
};

/// Returns the mean luminance of a white Lambertian sphere in an environment over all points of its disc. Sums, over
/// the pixels of the environment, their luminance times the sphere's phase function, 2/3 (sin a + (pi - a) cos a) / pi
/// for a parallel light at the angle a from the camera. O(pixels).
[[nodiscard]] double white_sphere_luminance(const environment_map& map);

namespace detail {

/// Two numbers for the position of a sample within its pixel, two for its direction.
struct sample_numbers {
  double x = 0.0, y = 0.0, u = 0.0, v = 0.0;
};

/// A sequence of quadruples (x, y, u, v) that fill [0, 1)^4 evenly from a random start. u increases in equal steps. x,
/// y and v step by powers of the root of t^4 = t + 1 (M. Roberts, "The Unreasonable Effectiveness of Quasirandom
/// Sequences", 2018), so any short run also fills these three dimensions evenly.
class even_numbers {
 public:
  even_numbers(Eigen::Index count, std::mt19937_64& generator);

  [[nodiscard]] sample_numbers operator[](Eigen::Index i) const noexcept {
    const auto number = static_cast<double>(i);
    const auto at = [number](double first, double step) {
      const double sum = first + number * step;
      return sum - std::floor(sum);
    };
    return {at(first_.x, 0.81917251339616443), at(first_.y, 0.67104360670378915), (number + first_.u) / count_,
            at(first_.v, 0.54970047790197026)};
  }

 private:
  double count_;
  sample_numbers first_;
};

/// Light that is reflected towards the camera from a drawn direction, and the densities in sr^-1 with which the
/// material and the light draw this direction.
struct drawn_light {
  rgb reflected = rgb::Zero();  ///< BRDF times radiance times cosine
  double by_material = 0.0, by_light = 0.0;

  /// Returns the density of the direction if the material draws the fraction `share` of all directions.
  [[nodiscard]] double density(double share) const noexcept { return share * by_material + (1.0 - share) * by_light; }
};

template <direction_sampler Sampler>
[[nodiscard]] drawn_light draw_by_material(const Sampler& material, const environment_sampler& light,
                                           const surface_frame& surface, double u, double v) {
  const sampled_direction drawn = material.sample(surface.to_local(direction::UnitZ()), u, v);
  if (!(drawn.weight > 0.0).any()) return {};
  const sampled_light lamp = light.from(surface.to_world(drawn.wi));
  return {drawn.weight * drawn.pdf * lamp.radiance, drawn.pdf, lamp.pdf};
}

template <direction_sampler Sampler>
[[nodiscard]] drawn_light draw_by_light(const Sampler& material, const environment_sampler& light,
                                        const surface_frame& surface, double u, double v) {
  const sampled_light lamp = light.sample(u, v);
  const direction wi = surface.to_local(lamp.towards), wo = surface.to_local(direction::UnitZ());
  if (!(wi.z() > 0.0)) return {};
  return {rgb(material.brdf()(wi, wo)) * lamp.radiance * wi.z(), material.pdf(wi, wo), lamp.pdf};
}

/// Renders tiles of the sphere.
template <direction_sampler Sampler>
class sphere_tiles {
 public:
  static constexpr Eigen::Index side = 8;

  sphere_tiles(const Sampler& material, const environment_sampler& light, const sampled_sphere_view& view)
      : material_(material), light_(light), view_(view), across_((view.size + side - 1) / side) {}

  [[nodiscard]] Eigen::Index count() const noexcept { return across_ * across_; }

  void render(Eigen::Index tile, double exposure, image& picture) const {
    const Eigen::Index top = tile / across_ * side, left = tile % across_ * side;
    std::mt19937_64 generator(view_.seed * 0x9E3779B97F4A7C15u + tile);
    const double share = share_of_material(top, left, generator);
    for (Eigen::Index row = top; row < std::min<Eigen::Index>(top + side, view_.size); ++row)
      for (Eigen::Index column = left; column < std::min<Eigen::Index>(left + side, view_.size); ++column)
        set_pixel(picture, row, column, exposure * pixel(row, column, share, generator));
  }

 private:
  /// A point of the image: x to the right and y upwards, from -1 to 1.
  struct image_point {
    double x, y, squared;
    [[nodiscard]] bool is_on_sphere() const noexcept { return squared < 1.0; }
  };
  [[nodiscard]] surface_frame surface_at(const image_point& seen) const noexcept {
    const direction normal(seen.x, seen.y, std::sqrt(1.0 - seen.squared));
    return view_.is_turned ? surface_frame::around(direction::UnitY(), normal) : surface_frame(normal);
  }
  [[nodiscard]] image_point at(double row, double column) const noexcept {
    const double x = column / view_.size * 2.0 - 1.0, y = 1.0 - row / view_.size * 2.0;
    return {x, y, x * x + y * y};
  }

  /// Returns the fraction of directions to be drawn by the material, in eighths: the fraction with the smallest second
  /// moment under the balance heuristic. Estimates the second moments from a tile, with equally many directions drawn
  /// by material and light.
  [[nodiscard]] double share_of_material(Eigen::Index top, Eigen::Index left, std::mt19937_64& generator) const {
    std::array<double, 7> second_moments{};
    constexpr Eigen::Index pairs = side * side;
    const even_numbers numbers(pairs, generator);
    for (Eigen::Index i = 0; i < pairs; ++i) {
      const sample_numbers u = numbers[i];
      const image_point seen = at(static_cast<double>(top) + side * u.y, static_cast<double>(left) + side * u.x);
      if (!seen.is_on_sphere()) continue;
      const surface_frame surface = surface_at(seen);
      for (const drawn_light& drawn : {draw_by_material(material_, light_, surface, u.u, u.v),
                                       draw_by_light(material_, light_, surface, u.u, u.v)})
        if (const double value = luminance(drawn.reflected); value > 0.0)
          for (Eigen::Index k = 0; k < std::ssize(second_moments); ++k)
            second_moments[k] += value * value / (drawn.density(0.5) * drawn.density(eighths(k)));
    }
    return eighths(std::ranges::min_element(second_moments) - second_moments.begin());
  }
  [[nodiscard]] static double eighths(Eigen::Index k) noexcept { return static_cast<double>(k + 1) / 8.0; }

  [[nodiscard]] rgb pixel(Eigen::Index row, Eigen::Index column, double share, std::mt19937_64& generator) const {
    const Eigen::Index all = 2 * Eigen::Index{view_.samples};
    const Eigen::Index by_material =
        std::clamp<Eigen::Index>(std::lround(share * static_cast<double>(all)), 1, all - 1);
    const double exact = static_cast<double>(by_material) / static_cast<double>(all);
    rgb sum = rgb::Zero();
    const auto add = [&](Eigen::Index count, auto draw) {
      const even_numbers numbers(count, generator);
      for (Eigen::Index i = 0; i < count; ++i) {
        const sample_numbers u = numbers[i];
        const image_point seen = at(static_cast<double>(row) + u.y, static_cast<double>(column) + u.x);
        if (!seen.is_on_sphere()) {
          if (view_.shows_environment) sum += light_.map()(direction(seen.x, seen.y, -3.0));
        } else if (const drawn_light drawn = draw(material_, light_, surface_at(seen), u.u, u.v);
                   (drawn.reflected > 0.0).any()) {
          sum += drawn.reflected / drawn.density(exact);
        }
      }
    };
    add(by_material, draw_by_material<Sampler>);
    add(all - by_material, draw_by_light<Sampler>);
    return sum / static_cast<double>(all);
  }

  const Sampler& material_;
  const environment_sampler& light_;
  const sampled_sphere_view& view_;
  Eigen::Index across_;
};

}  // namespace detail

/// Renders an image of a sphere in linear light. Scales the environment so that a white Lambertian sphere would have
/// the mean luminance `view.white`. `material` must draw its own directions and have `brdf()`, like
/// `half_vector_sampler`. The fraction of directions that the BRDF draws is chosen for each tile of 8 x 8 pixels. The
/// bytes do not depend on the number of threads. O(pixels x samples).
template <direction_sampler Sampler>
[[nodiscard]] image render_sphere(const Sampler& material, const environment_sampler& light,
                                  const sampled_sphere_view& view = {}, thread_count threads = {},
                                  const progress& listener = {}) {
  GONIO_ASSERT(view.size >= 1 && view.samples >= 1);
  const double exposure = view.white / white_sphere_luminance(light.map());
  image picture = uniform_image(view.size, view.size, rgb::Zero());
  const detail::sphere_tiles tiles(material, light, view);
  std::mutex reporting;
  Eigen::Index done = 0;
  for_each_block(
      tiles.count(), 1,
      [&](block range) {
        tiles.render(range.begin, exposure, picture);
        const std::scoped_lock lock(reporting);
        report(listener, "rendering", static_cast<double>(++done) / static_cast<double>(tiles.count()));
      },
      threads);
  return picture;
}

}  // namespace gonio::render

#if !defined(GONIO_COMPILED)
#include <gonio/render/impl/sampled_sphere.ipp>
#endif
