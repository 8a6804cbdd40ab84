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
#include <cstdint>
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
///
/// Pixels are in the order of Hilbert's curve (M. Steigleder and M. McCool, "Generalized Stratified Sampling Using the
/// Hilbert Curve", Journal of Graphics Tools 8(3), 2003): first numbers spread evenly give directions spread evenly.
class environment_sampler {
 public:
  /// O(pixels); sixteen bytes each.
  explicit environment_sampler(environment_map map);

  [[nodiscard]] const environment_map& map() const noexcept { return map_; }

  /// Draws a direction by two numbers from 0 up to 1. The pixel is found in O(1) on average (H.-C. Chen and Y. Asau,
  /// "On Generating Random Variates from an Empirical Distribution", AIIE Transactions 6(2), 1974: a table of first
  /// guesses).
  [[nodiscard]] sampled_light sample(double u1, double u2) const noexcept {
    const double share = u1 * reached_.back();
    const auto guess = guesses_.begin() + static_cast<std::ptrdiff_t>(u1 * static_cast<double>(guesses_.size() - 1));
    const auto first = reached_.begin() + 1;
    const auto above = std::upper_bound(first + guess[0], first + guess[1], share);
    const std::size_t place = above - first, pixel_number = order_[place];
    const std::size_t row = pixel_number / map_.columns(), column = pixel_number % map_.columns();
    // Where in its pixel the first number fell is as good as a third one.
    const double within = std::clamp((share - reached_[place]) / (*above - reached_[place]), 0.0, 1.0);
    const double height = edges_[row] + within * (edges_[row + 1] - edges_[row]);
    const double across = std::sqrt(std::max(0.0, 1.0 - height * height));
    return light_of(environment_map::towards({height, across}, static_cast<double>(column) + u2, map_.rows()),
                    pixel(map_.image(), row, column));
  }

  /// The light from a world direction, and the density in sr^-1 with which `sample` draws it.
  [[nodiscard]] sampled_light from(const direction& towards) const noexcept { return light_of(towards, map_(towards)); }

  /// The density in sr^-1 with which `sample` draws a world direction.
  [[nodiscard]] double pdf(const direction& towards) const noexcept { return from(towards).pdf; }

 private:
  [[nodiscard]] sampled_light light_of(const direction& towards, const rgb& radiance) const noexcept {
    return {towards, radiance, luminance(radiance) * pdf_per_luminance_};
  }

  environment_map map_;
  std::vector<std::uint32_t> order_;    ///< the number of each pixel along the curve
  std::vector<double> reached_;         ///< the sum of luminance times solid angle before each of them, and of all
  std::vector<std::uint32_t> guesses_;  ///< the places along the curve at even steps of that sum
  std::vector<double> edges_;           ///< cosines of the angles from +y between rows
  double pdf_per_luminance_ = 0.0;
};

}  // namespace gonio::render

#if !defined(GONIO_COMPILED)
#include <gonio/render/impl/environment_sampler.ipp>
#endif
