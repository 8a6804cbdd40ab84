#pragma once
/// Draws directions towards the bright parts of an environment map, in proportion to its luminance. Importance sampling
/// of a BRDF alone misses a small bright lamp. M. Pharr, W. Jakob and G. Humphreys, "Physically Based Rendering", 4th
/// edition 2023, Sec. 12.5.2; to combine two samplers, weight as in E. Veach and L. Guibas, "Optimally Combining
/// Sampling Techniques for Monte Carlo Rendering", SIGGRAPH 1995 (doi:10.1145/218380.218498).

#include <gonio/render/environment_map.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace gonio::render {

/// A world direction towards light, its radiance, and the density in sr^-1 with which it was drawn.
struct sampled_light {
  direction towards = direction::UnitY();
  rgb radiance = rgb::Zero();
  double pdf = 0.0;
};

/// Draws a pixel of an environment map in proportion to its luminance times solid angle, and then a direction that is
/// uniform within the pixel. Holds the map.
///
/// Pixels are ordered along Hilbert's curve (M. Steigleder and M. McCool, "Generalized Stratified Sampling Using the
/// Hilbert Curve", Journal of Graphics Tools 8(3), 2003), so evenly spaced numbers u1 give evenly spread directions.
class environment_sampler {
 public:
  /// O(pixels); 16 bytes each.
  explicit environment_sampler(environment_map map);

  [[nodiscard]] const environment_map& map() const noexcept { return map_; }

  /// Draws a direction from two numbers in [0, 1). Finds the pixel in O(1) on average with a table of first guesses
  /// (H.-C. Chen and Y. Asau, "On Generating Random Variates from an Empirical Distribution", AIIE Transactions 6(2),
  /// 1974).
  [[nodiscard]] sampled_light sample(double u1, double u2) const noexcept {
    const double share = u1 * reached_.back();
    const auto guess = guesses_.begin() + static_cast<std::ptrdiff_t>(u1 * static_cast<double>(guesses_.size() - 1));
    const auto first = reached_.begin() + 1;
    const auto above = std::upper_bound(first + guess[0], first + guess[1], share);
    const std::size_t position = above - first, pixel_number = order_[position];
    const std::size_t row = pixel_number / map_.columns(), column = pixel_number % map_.columns();
    // The position of u1 within its pixel's share serves as a third random number.
    const double within = std::clamp((share - reached_[position]) / (*above - reached_[position]), 0.0, 1.0);
    const double height = edges_[row] + within * (edges_[row + 1] - edges_[row]);
    const double across = std::sqrt(std::max(0.0, 1.0 - height * height));
    return light_of(environment_map::towards({height, across}, static_cast<double>(column) + u2, map_.rows()),
                    pixel(map_.image(), row, column));
  }

  /// Returns the light from a world direction, and the density in sr^-1 with which `sample` draws it.
  [[nodiscard]] sampled_light from(const direction& towards) const noexcept { return light_of(towards, map_(towards)); }

  /// Returns the density in sr^-1 with which `sample` draws a world direction.
  [[nodiscard]] double pdf(const direction& towards) const noexcept { return from(towards).pdf; }

 private:
  [[nodiscard]] sampled_light light_of(const direction& towards, const rgb& radiance) const noexcept {
    return {towards, radiance, luminance(radiance) * pdf_per_luminance_};
  }

  environment_map map_;
  std::vector<std::uint32_t> order_;  ///< the pixels, ordered along the curve
  std::vector<double>
      reached_;  ///< the sums of luminance times solid angle before each pixel on the curve, and the total
  std::vector<std::uint32_t> guesses_;  ///< positions along the curve at equal steps of `reached_`
  std::vector<double> edges_;           ///< cosines of the angles from +y at the borders between rows
  double pdf_per_luminance_ = 0.0;
};

}  // namespace gonio::render

#if !defined(GONIO_COMPILED)
#include <gonio/render/impl/environment_sampler.ipp>
#endif
