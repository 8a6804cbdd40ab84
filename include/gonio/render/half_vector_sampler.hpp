#pragma once
/// Directions for a renderer to follow, drawn where an isotropic BRDF is bright: half vectors from a tabulated
/// distribution, or cosine-weighted directions, in a ratio of their own for each viewer. After J. Lawrence, S.
/// Rusinkiewicz and R. Ramamoorthi, "Efficient BRDF Importance Sampling Using a Factored Representation", SIGGRAPH
/// 2004, of whose factors this is the one that matters most, and M. Pharr, W. Jakob and G. Humphreys, "Physically Based
/// Rendering", 2023, Sec. 9.6 (densities of reflected directions).

#include <gonio/core/brdf.hpp>
#include <gonio/core/sampled_direction.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace gonio {

namespace detail {

/// A distribution of half vectors about the normal, constant in solid angle over each of some rings.
class half_vector_distribution {
 public:
  /// Rings like MERL's, finer towards the normal, and how bright each is, per solid angle.
  explicit half_vector_distribution(const std::vector<double>& brightness) {
    const std::size_t rings = brightness.size();
    double sum = 0.0;
    reached_.push_back(0.0);
    for (std::size_t k = 0; k <= rings; ++k) heights_.push_back(below_pole(border(k, rings)));
    for (std::size_t k = 0; k < rings; ++k) {
      sum += brightness[k] * (heights_[k + 1] - heights_[k]);
      reached_.push_back(sum);
    }
    for (double& share : reached_) share /= sum;
    for (std::size_t k = 0; k < rings; ++k)
      densities_.push_back((reached_[k + 1] - reached_[k]) /
                           (2.0 * std::numbers::pi * (heights_[k + 1] - heights_[k])));
  }

  /// The angle from the normal at which a ring begins.
  [[nodiscard]] static double border(std::size_t ring, std::size_t rings) {
    const double fraction = static_cast<double>(ring) / static_cast<double>(rings);
    return fraction * fraction * (std::numbers::pi / 2.0);
  }

  [[nodiscard]] direction sample(double u1, double u2) const noexcept {
    const auto above = std::upper_bound(reached_.begin() + 1, reached_.end() - 1, u1) - reached_.begin();
    const auto ring = static_cast<std::size_t>(above - 1);
    const double share = (u1 - reached_[ring]) / (reached_[ring + 1] - reached_[ring]);
    const double height = heights_[ring] + std::clamp(share, 0.0, 1.0) * (heights_[ring + 1] - heights_[ring]);
    const double across = std::sqrt(height * (2.0 - height)), azimuth = 2.0 * std::numbers::pi * u2;
    return {across * std::cos(azimuth), across * std::sin(azimuth), 1.0 - height};
  }

  /// Per solid angle, of a vector of any length above the horizon.
  [[nodiscard]] double pdf(const direction& h) const noexcept {
    const double across = h.x() * h.x() + h.y() * h.y(), length = std::sqrt(across + h.z() * h.z());
    const double height = across / (length * (length + h.z()));  // 1 - cos, without cancellation
    const auto above = std::upper_bound(heights_.begin() + 1, heights_.end() - 1, height) - heights_.begin();
    return densities_[static_cast<std::size_t>(above - 1)];
  }

 private:
  /// 1 - cos: what is above it on the unit sphere is 2 pi times that.
  [[nodiscard]] static double below_pole(double angle) {
    const double s = std::sin(angle / 2.0);
    return 2.0 * s * s;
  }

  std::vector<double> heights_, reached_, densities_;
};

}  // namespace detail

/// Importance sampling of any isotropic BRDF. It holds the BRDF; give it a view where that is large.
///
/// `sample`, `pdf` and the BRDF itself agree: the weight times pdf is f cos(theta_i), and pdf integrates to 1 over the
/// sphere of directions. Some half vectors reflect the viewer below the horizon: these directions have weight 0 and are
/// counted by pdf, as renderers expect who test it. Cosine-weighted directions are at least a tenth, so that a weight
/// is at most 10 pi f.
template <brdf Brdf>
class half_vector_sampler {
 public:
  /// Measures where the BRDF is bright: some 50,000 evaluations.
  explicit half_vector_sampler(Brdf f) : f_(std::move(f)), distribution_(brightness_of_rings()) {
    for (std::size_t i = 0; i < ratios_.size(); ++i)
      ratios_[i] = best_ratio((static_cast<double>(i) + 0.5) / static_cast<double>(ratios_.size()));
  }

  [[nodiscard]] const Brdf& brdf() const noexcept { return f_; }

  /// Draws a direction by two numbers from 0 up to 1. Zero weight and density if wo is not above the horizon.
  [[nodiscard]] sampled_direction sample(const direction& wo, double u1, double u2) const noexcept {
    if (!(wo.z() > 0.0)) return {};
    const double ratio = ratio_of(wo);
    sampled_direction drawn;
    if (u1 < ratio) {  // a half vector
      const direction h = distribution_.sample(u1 / ratio, u2);
      drawn.wi = 2.0 * wo.dot(h) * h - wo;
    } else {
      drawn.wi = cosine_weighted_direction((u1 - ratio) / (1.0 - ratio), u2);
    }
    drawn.pdf = pdf(drawn.wi, wo);
    if (drawn.wi.z() > 0.0 && drawn.pdf > 0.0) drawn.weight = f_(drawn.wi, wo) * (drawn.wi.z() / drawn.pdf);
    return drawn;
  }

  /// The density in sr^-1 with which `sample` draws wi, anywhere on the sphere.
  [[nodiscard]] double pdf(const direction& wi, const direction& wo) const noexcept {
    if (!(wo.z() > 0.0)) return 0.0;
    const double ratio = ratio_of(wo);
    return ratio * half_vector_pdf(wi, wo) + (1.0 - ratio) * cosine_weighted_pdf(wi);
  }

  /// The share of half vectors for a viewer.
  [[nodiscard]] double ratio_of(const direction& wo) const noexcept {
    const auto bin = static_cast<std::size_t>(wo.z() * static_cast<double>(ratios_.size()));
    return ratios_[std::min(bin, ratios_.size() - 1)];
  }

 private:
  static constexpr std::size_t rings = 90;

  [[nodiscard]] double half_vector_pdf(const direction& wi, const direction& wo) const noexcept {
    direction h = wi + wo;
    if (h.z() < 0.0) h = -h;  // the same direction is reflected by both
    const double length = h.norm();
    if (!(length > 0.0)) return 0.0;
    return distribution_.pdf(h) * length / (4.0 * std::abs(wo.dot(h)));
  }

  /// The mean over difference angles of f, times the cosine of the ring.
  [[nodiscard]] std::vector<double> brightness_of_rings() const {
    constexpr int thetas = 12, phis = 12;
    std::vector<double> brightness;
    for (std::size_t ring = 0; ring < rings; ++ring) {
      const double theta_h = (detail::half_vector_distribution::border(ring, rings) +
                              detail::half_vector_distribution::border(ring + 1, rings)) /
                             2.0;
      double sum = 0.0, weights = 1e-9;
      for (int i = 0; i < thetas; ++i)
        for (int j = 0; j < phis; ++j) {
          const double theta_d = std::numbers::pi / 2.0 * (i + 0.5) / thetas;
          const auto [wi, wo] = to_directions({theta_h, theta_d, std::numbers::pi * (j + 0.5) / phis});
          if (!(wi.z() > 0.0 && wo.z() > 0.0)) continue;
          const double weight = std::sin(2.0 * theta_d) * wi.z();
          sum += weight * std::max(f_(wi, wo).mean(), 0.0);
          weights += weight;
        }
      brightness.push_back(sum / weights * std::cos(theta_h) + 1e-6);
    }
    return brightness;
  }

  /// The share of half vectors that makes the weights of a viewer vary least.
  [[nodiscard]] double best_ratio(double cosine) const {
    const direction wo(std::sqrt(1.0 - cosine * cosine), 0.0, cosine);
    constexpr std::array ratios{0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};
    std::array<double, ratios.size()> second_moment{};
    // Directions of an even mixture, stratified, each with the moments under the other ratios.
    constexpr int side = 24;
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j)
        for (const bool is_cosine : {false, true}) {
          const double u1 = (i + 0.5) / side, u2 = (j + 0.5) / side;
          const direction h = distribution_.sample(u1, u2);
          const direction wi = is_cosine ? cosine_weighted_direction(u1, u2) : direction(2.0 * wo.dot(h) * h - wo);
          if (!(wi.z() > 0.0)) continue;
          const double by_half = half_vector_pdf(wi, wo), by_cosine = cosine_weighted_pdf(wi);
          const double value = f_(wi, wo).mean() * wi.z(), drawn = 0.5 * (by_half + by_cosine);
          for (std::size_t r = 0; r < ratios.size(); ++r)
            second_moment[r] += value * value / (ratios[r] * by_half + (1.0 - ratios[r]) * by_cosine) / drawn;
        }
    return ratios[static_cast<std::size_t>(std::ranges::min_element(second_moment) - second_moment.begin())];
  }

  Brdf f_;
  detail::half_vector_distribution distribution_;
  std::array<double, 32> ratios_{};
};

}  // namespace gonio
