#pragma once
/// Importance sampling of isotropic BRDFs for a renderer. Draws half vectors from a distribution tabulated for each of
/// 16 viewers, or cosine-weighted directions, in a ratio chosen for each viewer. After J. Lawrence, S. Rusinkiewicz and
/// R. Ramamoorthi, "Efficient BRDF Importance Sampling Using a Factored Representation", SIGGRAPH 2004
/// (doi:10.1145/1015706.1015751), whose half-vector factor is tabulated here without factorisation, and M. Pharr, W.
/// Jakob and G. Humphreys, "Physically Based Rendering", 2023, Sec. 9.6 (densities of reflected directions).

#include <gonio/core/brdf.hpp>
#include <gonio/core/sampled_direction.hpp>
#include <gonio/render/grid_coordinates.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

namespace gonio::render {

namespace detail {

/// Divides half vectors into rings about the normal, finer towards it like MERL's, and each ring into sectors of
/// azimuth from the viewer's azimuth. Sectors on the left also stand for those on the right. A distribution is constant
/// in solid angle within each bin.
template <std::floating_point Real>
class half_vector_bins {
 public:
  static constexpr Eigen::Index rings = 60, sectors = 8, count = rings * sectors;
  /// For each bin, the share of the distribution that is in the bins before; 1 at the end.
  using cumulative = std::array<float, count + 1>;

  half_vector_bins() {
    for (Eigen::Index ring = 0; ring <= rings; ++ring) {
      const double share = static_cast<double>(ring) / static_cast<double>(rings);
      const double s = std::sin(share * share * (std::numbers::pi / 4.0));
      heights_[ring] = static_cast<Real>(2.0 * s * s);  // 1 - cos of the angle; times 2 pi, the solid angle within it
    }
  }

  /// Returns the solid angle of a bin: its left and its right part together.
  [[nodiscard]] Real solid_angle(Eigen::Index bin) const noexcept {
    const Eigen::Index ring = bin / sectors;
    return (heights_[ring + 1] - heights_[ring]) * (2 * std::numbers::pi_v<Real> / static_cast<Real>(sectors));
  }

  /// Returns a half vector in the left part of a bin, for a viewer in the xz plane. `along` and `around` are its
  /// position in the bin, from 0 to 1.
  [[nodiscard]] Eigen::Matrix<Real, 3, 1> within(Eigen::Index bin, Real along, Real around) const noexcept {
    const Eigen::Index ring = bin / sectors;
    const Real height = heights_[ring] + along * (heights_[ring + 1] - heights_[ring]);
    const Real azimuth =
        (static_cast<Real>(bin % sectors) + around) * (std::numbers::pi_v<Real> / static_cast<Real>(sectors));
    const Real across = std::sqrt(height * (2 - height));
    return {across * std::cos(azimuth), across * std::sin(azimuth), 1 - height};
  }

  /// Returns the bin of a half vector h of any length above the horizon, for a viewer in the xz plane.
  [[nodiscard]] Eigen::Index bin_of(const Eigen::Matrix<Real, 3, 1>& h) const noexcept {
    const Real across = h.x() * h.x() + h.y() * h.y(), up = h.z() * h.z();
    const Real squared = std::min(across, up) / std::max(across, up);
    const Real share = std::sqrt(quarter_turns(std::sqrt(squared), squared, across > up ? Real(1) : Real(0)));
    const azimuth_terms<Real> phi(h.x(), std::abs(h.y()));
    const Real turn = half_turns(quarter_turns(phi.tangent, phi.tangent * phi.tangent, phi.steep), phi.left);
    return part_of(share, rings) * sectors + part_of(turn, sectors);
  }

 private:
  [[nodiscard]] static Eigen::Index part_of(Real share, Eigen::Index parts) noexcept {
    return std::min<std::size_t>(static_cast<std::size_t>(share * static_cast<Real>(parts)), parts - 1);
  }

  std::array<Real, rings + 1> heights_{};
};

}  // namespace detail

/// Importance sampling of any isotropic BRDF, in `float` or `double`. It holds a copy of the BRDF; pass a `brdf_view`
/// to share it. Its own tables need 31 KB.
///
/// `sample`, `pdf` and the BRDF are consistent: the weight times pdf is f cos(theta_i), and pdf integrates to 1 over
/// the sphere of directions. One or two half vectors in a hundred reflect the viewer below the horizon. The resulting
/// directions have weight 0, and pdf includes them, as the tests of renderers expect. At least a tenth of the
/// directions is cosine-weighted, so a weight is at most 10 pi f. `gonio-papers importance-sampling` compares its
/// variance with that of cosine-weighted directions.
template <class Brdf, std::floating_point Real = double>
requires requires(const Brdf& f, const Eigen::Matrix<Real, 3, 1>& w) {
  { f(w, w) }
  noexcept->std::convertible_to<Eigen::Array<Real, 3, 1>>;
}
class half_vector_sampler {
 public:
  using vector = Eigen::Matrix<Real, 3, 1>;

  /// Tabulates the distributions with about 150,000 evaluations of the BRDF.
  explicit half_vector_sampler(Brdf f) : f_(std::move(f)), distributions_(viewers), ratios_(viewers) {
    for (Eigen::Index viewer = 0; viewer < viewers; ++viewer) {
      distributions_[viewer] = distribution_for(viewer);
      ratios_[viewer] = best_ratio(viewer);
    }
  }

  [[nodiscard]] const Brdf& brdf() const noexcept { return f_; }

  /// Draws a direction from two numbers in [0, 1). Weight and density are zero if wo is not above the horizon.
  [[nodiscard]] basic_sampled_direction<Real> sample(const vector& wo, Real u1, Real u2) const noexcept {
    basic_sampled_direction<Real> drawn = draw(wo, u1, u2);
    if (drawn.wi.z() > 0 && drawn.pdf > 0)
      drawn.weight = Eigen::Array<Real, 3, 1>(f_(drawn.wi, wo)) * (drawn.wi.z() / drawn.pdf);
    return drawn;
  }

  /// Draws the direction of `sample`, but leaves its weight 0, for use with another BRDF.
  [[nodiscard]] basic_sampled_direction<Real> draw(const vector& wo, Real u1, Real u2) const noexcept {
    if (!(wo.z() > 0)) return {};
    const Eigen::Index viewer = viewer_of(wo);
    const Real ratio = ratios_[viewer];
    basic_sampled_direction<Real> drawn;
    drawn.wi = u1 < ratio ? mirrored(wo, viewer_turn(wo).from_plane(half_vector(viewer, u1 / ratio, u2)))
                          : cosine_weighted_direction((u1 - ratio) / (1 - ratio), u2);
    drawn.pdf = pdf(drawn.wi, wo);
    return drawn;
  }

  /// Returns the density in sr^-1 with which `sample` draws wi, anywhere on the sphere.
  [[nodiscard]] Real pdf(const vector& wi, const vector& wo) const noexcept {
    if (!(wo.z() > 0)) return 0;
    const Eigen::Index viewer = viewer_of(wo);
    const Real ratio = ratios_[viewer];
    return ratio * half_vector_pdf(viewer, wi, wo) + (1 - ratio) * cosine_weighted_pdf(wi);
  }

  /// Returns the fraction of directions that are drawn by half vectors for a viewer.
  [[nodiscard]] Real ratio_of(const vector& wo) const noexcept { return ratios_[viewer_of(wo)]; }

 private:
  static constexpr Eigen::Index viewers = 16;
  using bins = detail::half_vector_bins<Real>;

  /// Returns the index of a viewer. It is proportional to sqrt(1 - cos theta_o), which gives nearly equal steps of the
  /// angle.
  [[nodiscard]] static Eigen::Index viewer_of(const vector& wo) noexcept {
    const Real position = std::sqrt(std::max(1 - wo.z(), Real(0))) * static_cast<Real>(viewers);
    return std::min<std::size_t>(static_cast<std::size_t>(position), viewers - 1);
  }
  /// Returns a viewer in the xz plane. `share` is its position in the interval of its index, from 0 to 1.
  [[nodiscard]] static vector a_viewer(Eigen::Index viewer, double share) {
    const double position = (static_cast<double>(viewer) + share) / static_cast<double>(viewers);
    const double z = 1.0 - position * position;
    return {static_cast<Real>(std::sqrt(1.0 - z * z)), 0, static_cast<Real>(z)};
  }

  [[nodiscard]] static vector mirrored(const vector& wo, const vector& h) noexcept { return 2 * wo.dot(h) * h - wo; }

  /// The rotation from the xz plane to the plane of viewer and normal: cosine and sine. A viewer at the normal is in
  /// the xz plane.
  struct viewer_turn {
    Real c = 1, s = 0;

    explicit viewer_turn(const vector& wo) noexcept {
      const Real across = std::sqrt(wo.x() * wo.x() + wo.y() * wo.y());
      if (!(across > 0)) return;
      c = wo.x() / across;
      s = wo.y() / across;
    }
    [[nodiscard]] vector from_plane(const vector& h) const noexcept {
      return {c * h.x() - s * h.y(), s * h.x() + c * h.y(), h.z()};
    }
    [[nodiscard]] vector to_plane(const vector& h) const noexcept {
      return {c * h.x() + s * h.y(), c * h.y() - s * h.x(), h.z()};
    }
  };

  /// Draws a half vector for a viewer in the xz plane. If u2 is at least 1/2, the half vector is on the right side.
  [[nodiscard]] vector half_vector(Eigen::Index viewer, Real u1, Real u2) const noexcept {
    const auto& before = distributions_[viewer];
    const auto above = std::upper_bound(before.begin() + 1, before.end() - 1, static_cast<float>(u1));
    const Eigen::Index bin = (above - before.begin()) - 1;
    const Real first = before[bin], last = before[bin + 1];
    const Real along = std::clamp((u1 - first) / (last - first), Real(0), Real(1));
    const bool is_right = u2 >= Real(0.5);
    vector h = bins_.within(bin, along, is_right ? 2 * u2 - 1 : 2 * u2);
    if (is_right) h.y() = -h.y();
    return h;
  }

  [[nodiscard]] Real half_vector_pdf(Eigen::Index viewer, const vector& wi, const vector& wo) const noexcept {
    vector h = wi + wo;
    if (h.z() < 0) h = -h;  // both h and -h reflect the same direction
    const Real length = h.norm();
    if (!(length > 0)) return 0;
    const Eigen::Index bin = bins_.bin_of(viewer_turn(wo).to_plane(h));
    const auto& before = distributions_[viewer];
    const Real density = static_cast<Real>(before[bin + 1] - before[bin]) / bins_.solid_angle(bin);
    return density * length / (4 * std::abs(wo.dot(h)));
  }

  /// Returns the distribution of half vectors that minimises the variance under uniform illumination. In each bin, the
  /// density is proportional to the root mean square of f cos(theta_i) per solid angle of half vectors, plus a small
  /// uniform part.
  [[nodiscard]] typename bins::cumulative distribution_for(Eigen::Index viewer) const {
    std::array<double, bins::count> share{};
    double sum = 0.0;
    for (Eigen::Index bin = 0; bin < bins::count; ++bin) {
      share[bin] = brightness(viewer, bin) * static_cast<double>(bins_.solid_angle(bin));
      sum += share[bin];
    }
    typename bins::cumulative before{};
    double reached = 0.0;
    for (Eigen::Index bin = 0; bin < bins::count; ++bin) {
      before[bin] = static_cast<float>(reached);
      const double of_all = static_cast<double>(bins_.solid_angle(bin)) / (2.0 * std::numbers::pi);
      reached += sum > 0.0 ? (1.0 - everywhere) * share[bin] / sum + everywhere * of_all : of_all;
    }
    before.back() = 1.0f;
    return before;
  }

  [[nodiscard]] double brightness(Eigen::Index viewer, Eigen::Index bin) const {
    constexpr int side = 3, seen = 2;
    double squares = 0.0;
    for (int view = 0; view < seen; ++view) {
      const vector wo = a_viewer(viewer, (view + 0.5) / seen);
      for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
          const vector h = bins_.within(bin, static_cast<Real>((i + 0.5) / side), static_cast<Real>((j + 0.5) / side));
          const vector wi = mirrored(wo, h);
          if (!(wi.z() > 0 && wo.dot(h) > 0)) continue;
          const double value = mean_of(wi, wo) * 4.0 * static_cast<double>(wo.dot(h));
          squares += value * value / (seen * side * side);
        }
    }
    return std::sqrt(squares);
  }

  /// Returns f cos(theta_i), averaged over the channels.
  [[nodiscard]] double mean_of(const vector& wi, const vector& wo) const {
    const Eigen::Array<Real, 3, 1> value = f_(wi, wo);
    return std::max(static_cast<double>(value.mean()), 0.0) * static_cast<double>(wi.z());
  }

  /// Returns the fraction of directions drawn by half vectors that minimises the variance of a viewer's weights.
  [[nodiscard]] Real best_ratio(Eigen::Index viewer) const {
    const vector wo = a_viewer(viewer, 0.5);
    constexpr std::array ratios{0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};
    std::array<double, ratios.size()> second_moment{};
    // Draw stratified directions, half of them by half vectors, and sum up the second moments for every ratio.
    constexpr int side = 24;
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j)
        for (const bool is_cosine : {false, true}) {
          const auto u1 = static_cast<Real>((i + 0.5) / side), u2 = static_cast<Real>((j + 0.5) / side);
          const vector wi = is_cosine ? cosine_weighted_direction(u1, u2) : mirrored(wo, half_vector(viewer, u1, u2));
          if (!(wi.z() > 0)) continue;
          const double by_half = half_vector_pdf(viewer, wi, wo), by_cosine = cosine_weighted_pdf(wi);
          const double value = mean_of(wi, wo), drawn = 0.5 * (by_half + by_cosine);
          for (Eigen::Index r = 0; r < std::ssize(ratios); ++r)
            second_moment[r] += value * value / (ratios[r] * by_half + (1.0 - ratios[r]) * by_cosine) / drawn;
        }
    return static_cast<Real>(ratios[std::ranges::min_element(second_moment) - second_moment.begin()]);
  }

  static constexpr double everywhere = 0.02;

  Brdf f_;
  bins bins_;
  std::vector<typename bins::cumulative> distributions_;  ///< per viewer
  std::vector<Real> ratios_;                              ///< per viewer
};

}  // namespace gonio::render
