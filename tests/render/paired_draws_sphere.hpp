#pragma once
/// The simplest renderer of a sphere in an environment. For each sample of a pixel, it draws one direction from the
/// BRDF and one from the environment by bisection, and combines them by the balance heuristic.
/// render/sampled_sphere.hpp is tested (tests/render/sampled_sphere.cpp) and timed
/// (bench/render/environment_sphere.cpp) against it.

#include <gonio/core/parallel.hpp>
#include <gonio/core/random.hpp>
#include <gonio/core/sampled_direction.hpp>
#include <gonio/render/environment_map.hpp>
#include <gonio/render/image.hpp>
#include <gonio/render/lighting.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace paired_draws {

using gonio::direction;
using gonio::rgb;

/// Draws pixels of a map in proportion to luminance times solid angle, in row order.
class row_by_row_light {
 public:
  explicit row_by_row_light(gonio::render::environment_map map) : map_(std::move(map)) {
    double sum = 0.0;
    for (std::size_t row = 0; row < map_.rows(); ++row)
      for (std::size_t column = 0; column < map_.columns(); ++column) {
        reached_.push_back(sum);
        sum += gonio::luminance(map_.irradiance(row, column));
      }
    reached_.push_back(sum);
  }

  /// Uses trigonometric functions.
  [[nodiscard]] rgb radiance(const direction& d) const {
    const double scale = static_cast<double>(map_.rows()) / std::numbers::pi;
    const double polar = std::atan2(std::hypot(d.x(), d.z()), d.y());
    const double longitude = std::atan2(d.x(), -d.z()) + std::numbers::pi;
    const auto row = std::min(static_cast<std::size_t>(polar * scale), map_.rows() - 1);
    const auto column = std::min(static_cast<std::size_t>(longitude * scale), map_.columns() - 1);
    return gonio::pixel(map_.image(), row, column);
  }
  [[nodiscard]] double pdf(const direction& towards) const {
    return gonio::luminance(radiance(towards)) / reached_.back();
  }

  struct lamp {
    direction towards;
    rgb radiance;
    double pdf;
  };
  [[nodiscard]] lamp sample(double u1, double u2) const {
    const double wanted = u1 * reached_.back();
    const auto above = std::upper_bound(reached_.begin() + 1, reached_.end() - 1, wanted);
    const std::size_t number = (above - reached_.begin()) - 1;
    const std::size_t row = number / map_.columns(), column = number % map_.columns();
    const double share = std::clamp((wanted - reached_[number]) / (*above - reached_[number]), 0.0, 1.0);
    const double step = std::numbers::pi / static_cast<double>(map_.rows());
    const double top = std::cos(static_cast<double>(row) * step),
                 bottom = std::cos(static_cast<double>(row + 1) * step);
    const double height = top + share * (bottom - top), across = std::sqrt(std::max(0.0, 1.0 - height * height));
    const rgb seen = gonio::pixel(map_.image(), row, column);
    return {gonio::render::environment_map::towards({height, across}, static_cast<double>(column) + u2, map_.rows()),
            seen, gonio::luminance(seen) / reached_.back()};
  }

 private:
  gonio::render::environment_map map_;
  std::vector<double> reached_;
};

struct pair {
  double u = 0.0, v = 0.0;
};

/// Evenly spaced triples of pairs (M. Roberts's sequence). The order of each kind is shuffled independently.
inline std::vector<std::array<pair, 3>> even_pairs(int count, std::uint64_t seed, std::uint64_t stream) {
  constexpr double root = 1.324717957244746;
  std::mt19937_64 generator(seed * 0x9E3779B97F4A7C15u + stream);
  std::vector<std::array<pair, 3>> all(count);
  for (std::size_t kind = 0; kind < 3; ++kind) {
    const double first_u = gonio::uniform_number(generator), first_v = gonio::uniform_number(generator);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double u = first_u + static_cast<double>(i) / root, v = first_v + static_cast<double>(i) / (root * root);
      all[i][kind] = {u - std::floor(u), v - std::floor(v)};
    }
    for (std::size_t i = all.size(); i > 1; --i) {
      const double chosen = gonio::uniform_number(generator) * static_cast<double>(i);
      std::swap(all[i - 1][kind], all[static_cast<std::size_t>(chosen)][kind]);
    }
  }
  return all;
}

/// Returns the light reflected by a surface towards a camera at +z.
template <class Sampler>
rgb reflected(const Sampler& material, const row_by_row_light& light, const gonio::render::surface_frame& surface,
              const std::array<pair, 3>& u) {
  const direction wo = surface.to_local(direction::UnitZ());
  rgb sum = rgb::Zero();
  if (const auto drawn = material.sample(wo, u[1].u, u[1].v); (drawn.weight > 0.0).any()) {
    const direction towards = surface.to_world(drawn.wi);
    sum += drawn.weight * light.radiance(towards) * (drawn.pdf / (drawn.pdf + light.pdf(towards)));
  }
  const auto lamp = light.sample(u[2].u, u[2].v);
  if (const direction wi = surface.to_local(lamp.towards); wi.z() > 0.0)
    sum += rgb(material.brdf()(wi, wo)) * lamp.radiance * (wi.z() / (lamp.pdf + material.pdf(wi, wo)));
  return sum;
}

/// Returns unexposed radiance, black outside the sphere.
template <class Sampler>
gonio::image render_sphere(const Sampler& material, const row_by_row_light& light, int size, int samples,
                           std::uint64_t seed, gonio::thread_count threads = {}) {
  const auto side = static_cast<Eigen::Index>(size);
  gonio::image picture = gonio::uniform_image(size, size, rgb::Zero());
  gonio::for_each_index(
      side * side, side,
      [&](Eigen::Index pixel) {
        rgb sum = rgb::Zero();
        const auto column = static_cast<double>(pixel % side), row = static_cast<double>(pixel / side);
        for (const auto& u : even_pairs(samples, seed, static_cast<std::uint64_t>(pixel))) {
          const double x = (column + u[0].u) / size * 2.0 - 1.0, y = 1.0 - (row + u[0].v) / size * 2.0;
          const double squared = x * x + y * y;
          if (squared < 1.0)
            sum += reflected(material, light, gonio::render::surface_frame({x, y, std::sqrt(1.0 - squared)}), u);
        }
        gonio::set_pixel(picture, pixel / side, pixel % side, sum / samples);
      },
      threads);
  return picture;
}

}  // namespace paired_draws
