#pragma once
/// Directions towards the bright parts of an environment map, drawn in proportion to its luminance: what importance
/// sampling of a BRDF alone misses, a small bright lamp. M. Pharr, W. Jakob and G. Humphreys, "Physically Based
/// Rendering", 4th edition 2023, Sec. 12.5.2; the weights for a draw that two samplers could have made are E. Veach and
/// L. Guibas's, "Optimally Combining Sampling Techniques for Monte Carlo Rendering", SIGGRAPH 1995
/// (doi:10.1145/218380.218498).

#include <gonio/render/environment_map.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace gonio::render {

/// A world direction that light comes from, its radiance, and the density in sr^-1 with which it was drawn.
struct sampled_light {
  direction towards = direction::UnitY();
  rgb radiance = rgb::Zero();
  double pdf = 0.0;
};

/// Draws directions of an environment map: a pixel in proportion to its luminance times solid angle, and any direction
/// within it. Holds the map.
class environment_sampler {
 public:
  /// O(pixels); eight bytes each.
  explicit environment_sampler(environment_map map);

  [[nodiscard]] const environment_map& map() const noexcept { return map_; }

  /// Draws a direction by two numbers from 0 up to 1.
  [[nodiscard]] sampled_light sample(double u1, double u2) const noexcept {
    const double place = u1 * reached_.back();
    const auto above = std::upper_bound(reached_.begin() + 1, reached_.end() - 1, place);
    const std::size_t pixel_number = (above - reached_.begin()) - 1;
    const std::size_t row = pixel_number / map_.columns(), column = pixel_number % map_.columns();
    // Where in its pixel the first number fell is as good as a third one.
    const double share = std::clamp((place - reached_[pixel_number]) / (*above - reached_[pixel_number]), 0.0, 1.0);
    const double step = std::numbers::pi / static_cast<double>(map_.rows());
    const double top = std::cos(static_cast<double>(row) * step),
                 bottom = std::cos(static_cast<double>(row + 1) * step);
    const double height = top + share * (bottom - top);
    const double across = std::sqrt(std::max(0.0, 1.0 - height * height));
    const rgb radiance = pixel(map_.image(), row, column);
    return {environment_map::towards({height, across}, static_cast<double>(column) + u2, map_.rows()), radiance,
            luminance(radiance) / reached_.back()};
  }

  /// The density in sr^-1 with which `sample` draws a world direction.
  [[nodiscard]] double pdf(const direction& towards) const noexcept {
    return luminance(map_(towards)) / reached_.back();
  }

 private:
  environment_map map_;
  std::vector<double> reached_;  ///< the sum of luminance times solid angle before each pixel, and of all
};

}  // namespace gonio::render

#if !defined(GONIO_COMPILED)
#include <gonio/render/impl/environment_sampler.ipp>
#endif
