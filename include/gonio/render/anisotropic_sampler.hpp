#pragma once
/// Importance sampling of anisotropic BRDFs: directions are drawn as for the BRDF's mean over azimuth, which is
/// isotropic, and weighted by the BRDF itself.

#include <gonio/core/brdf.hpp>
#include <gonio/core/sampled_direction.hpp>
#include <gonio/render/half_vector_sampler.hpp>

#include <cmath>
#include <numbers>
#include <utility>

namespace gonio::render {

/// The mean of a BRDF over 16 azimuths of the surface's axes.
template <brdf Brdf>
class azimuthal_mean {
 public:
  explicit azimuthal_mean(Brdf f) : f_(std::move(f)) {}

  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept {
    constexpr int turns = 16;
    rgb sum = rgb::Zero();
    for (int i = 0; i < turns; ++i) {
      const double turn = 2.0 * std::numbers::pi * i / turns;
      sum += rgb(f_(turned_about_normal(wi, turn), turned_about_normal(wo, turn)));
    }
    return sum / turns;
  }

  [[nodiscard]] const Brdf& of() const noexcept { return f_; }

 private:
  Brdf f_;
};

/// A `direction_sampler`. Construction evaluates the BRDF about a million times.
/// ```cpp
/// const gonio::render::anisotropic_sampler brushed(gonio::io::read_rgl("brushed.bsdf").material);
/// const auto [wi, weight, pdf] = brushed.sample(wo, u1, u2);
/// ```
template <brdf Brdf>
class anisotropic_sampler {
 public:
  explicit anisotropic_sampler(Brdf f) : mean_(azimuthal_mean<Brdf>(std::move(f))) {}

  [[nodiscard]] const Brdf& brdf() const noexcept { return mean_.brdf().of(); }

  [[nodiscard]] sampled_direction sample(const direction& wo, double u1, double u2) const noexcept {
    sampled_direction drawn = mean_.draw(wo, u1, u2);
    if (drawn.wi.z() > 0.0 && drawn.pdf > 0.0) drawn.weight = rgb(brdf()(drawn.wi, wo)) * (drawn.wi.z() / drawn.pdf);
    return drawn;
  }

  [[nodiscard]] double pdf(const direction& wi, const direction& wo) const noexcept { return mean_.pdf(wi, wo); }

 private:
  half_vector_sampler<azimuthal_mean<Brdf>> mean_;
};

}  // namespace gonio::render
