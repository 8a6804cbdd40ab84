#pragma once
/// Importance sampling of analytic BRDFs, for renderers: a single model, a sum of lobes or a fit's result. Each lobe is
/// sampled by its `techniques_of`, and each is chosen in proportion to its albedo: E. Veach and L. J. Guibas,
/// "Optimally Combining Sampling Techniques for Monte Carlo Rendering", SIGGRAPH 1995 (doi:10.1145/218380.218498).

#include <gonio/model/formula_materials.hpp>
#include <gonio/model/sampling_techniques.hpp>
#include <gonio/model/sum_of_lobes.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

namespace gonio::model {

namespace detail {

/// One number for each interval of cos(theta_o).
using by_viewer = std::array<double, 32>;

/// A mixture of densities, whose shares depend on the viewer and sum to 1. Only construction allocates memory.
class direction_mixture {
 public:
  void add(const sampling_technique::density_type& density, const by_viewer& shares) {
    entries_.push_back({density, shares});
  }

  [[nodiscard]] direction sample(const direction& wo, double u1, double u2) const noexcept {
    const Eigen::Index at = viewer(wo);
    const entry* chosen = nullptr;
    double share = 1.0;
    for (const entry& e : entries_) {
      if (!(e.shares[at] > 0.0)) continue;
      if (chosen) u1 -= share;
      chosen = &e;
      share = e.shares[at];
      if (u1 < share) break;
    }
    // Rescale the remainder of u1 within the chosen density's share to [0, 1).
    const double u = std::clamp(u1 / share, 0.0, 1.0 - 0x1p-53);
    return std::visit([&](const auto& density) { return density.sample(wo, u, u2); }, chosen->density);
  }

  [[nodiscard]] double pdf(const direction& wi, const direction& wo) const noexcept {
    const Eigen::Index at = viewer(wo);
    double sum = 0.0;
    for (const entry& e : entries_)
      if (e.shares[at] > 0.0)
        sum += e.shares[at] * std::visit([&](const auto& density) { return density.pdf(wi, wo); }, e.density);
    return sum;
  }

  /// Returns the cosine in the middle of an interval.
  [[nodiscard]] static double cosine_of(Eigen::Index interval) {
    return (static_cast<double>(interval) + 0.5) / static_cast<double>(by_viewer{}.size());
  }

 private:
  struct entry {
    sampling_technique::density_type density;
    by_viewer shares;
  };

  [[nodiscard]] static Eigen::Index viewer(const direction& wo) noexcept {
    constexpr Eigen::Index count = by_viewer{}.size();
    return std::min<std::size_t>(static_cast<std::size_t>(wo.z() * static_cast<double>(count)), count - 1);
  }

  std::vector<entry> entries_;
};

/// A lobe's sampling techniques and its albedo.
struct weighed_lobe {
  sampling_techniques techniques;
  by_viewer albedo;
};

/// Estimates a lobe's albedo for each interval of cos(theta_o) from 144 samples of wi, each with a different azimuth of
/// wo. The albedos only set the shares with which lobes are chosen, so an estimate suffices: sampling is unbiased
/// whatever the shares.
template <class Lobe>
[[nodiscard]] weighed_lobe weigh(const Lobe& f, const sampling_techniques& techniques) {
  direction_mixture own;
  for (const sampling_technique& technique : techniques) {
    by_viewer share;
    share.fill(technique.share);
    own.add(technique.density, share);
  }
  constexpr int side = 12;
  weighed_lobe weighed{techniques, {}};
  for (Eigen::Index interval = 0; interval < std::ssize(weighed.albedo); ++interval) {
    double sum = 0.0;
    for (int draw = 0; draw < side * side; ++draw) {
      const direction wo = spherical_direction(std::acos(direction_mixture::cosine_of(interval)), 2.4 * draw);
      const direction wi = own.sample(wo, (draw / side + 0.5) / side, (draw % side + 0.5) / side);
      const double pdf = own.pdf(wi, wo);
      if (wi.z() > 0.0 && pdf > 0.0) sum += rgb(f(wi, wo)).mean() * (wi.z() / pdf);
    }
    weighed.albedo[interval] = std::max(sum, 0.0) / (side * side);
  }
  return weighed;
}

template <class>
inline constexpr bool is_sum_of_lobes = false;
template <class... Lobes>
inline constexpr bool is_sum_of_lobes<sum_of_lobes<Lobes...>> = true;

/// Appends the lobes of a model with their techniques.
template <class Model>
void weigh_lobes(const Model& f, std::vector<weighed_lobe>& lobes) {
  if constexpr (std::same_as<Model, formula_brdf>) {
    std::visit([&](const auto& model) { weigh_lobes(model, lobes); }, f.formula());
  } else if constexpr (is_sum_of_lobes<Model>) {
    std::apply([&](const auto&... lobe) { (weigh_lobes(lobe, lobes), ...); }, f.lobes());
  } else if constexpr (std::same_as<Model, analytic_brdf>) {
    for (const analytic_lobe& lobe : f.lobes()) lobes.push_back(weigh(analytic_brdf({lobe}), techniques_of(lobe)));
  } else {
    lobes.push_back(weigh(f, techniques_of(f)));
  }
}

/// Samples each lobe in proportion to its albedo at the middle of a viewer's interval. Each lobe has a share of at
/// least about 1 %, because it may be brighter elsewhere in the interval.
[[nodiscard]] direction_mixture mixture_of(const std::vector<weighed_lobe>& lobes);

}  // namespace detail

/// Importance sampling of an analytic BRDF: any lobe, `lambertian`, `ggx`, a `sum_of_lobes`, an `analytic_brdf` such as
/// a fit's result, or a `formula_brdf`. Holds a copy of the BRDF.
/// ```cpp
/// const gonio::model::lobe_sampler paint{gonio::model::sum_of_lobes{gonio::model::lambertian{}, gonio::model::ggx{}}};
/// const auto drawn = paint.sample(wo, u1, u2);
/// ```
/// `sample`, `pdf` and the BRDF are consistent: the weight times pdf is f cos(theta_i), and pdf integrates to 1 over
/// the sphere of directions. Directions below the horizon can be drawn. They have weight 0, and pdf includes them.
///
/// A narrow lobe with analytically bounded weights is sampled by its own density alone. Lobes without such a bound
/// (Ward, Ward-Duer, Phong-Blinn) and wide lobes also draw cosine-weighted directions. A sum draws each lobe in
/// proportion to its albedo for the viewer. Construction estimates the albedos with about 5,000 evaluations per lobe.
template <brdf Brdf>
class lobe_sampler {
 public:
  using vector = direction;

  explicit lobe_sampler(Brdf f) : f_(std::move(f)) {
    std::vector<detail::weighed_lobe> lobes;
    detail::weigh_lobes(f_, lobes);
    mixture_ = detail::mixture_of(lobes);
  }

  [[nodiscard]] const Brdf& brdf() const noexcept { return f_; }

  /// Draws a direction from two numbers in [0, 1). Weight and density are zero if wo is not above the horizon.
  [[nodiscard]] sampled_direction sample(const direction& wo, double u1, double u2) const noexcept {
    if (!is_above_horizon(wo)) return {};
    sampled_direction drawn;
    drawn.wi = mixture_.sample(wo, u1, u2);
    drawn.pdf = mixture_.pdf(drawn.wi, wo);
    if (drawn.wi.z() > 0.0 && drawn.pdf > 0.0) drawn.weight = rgb(f_(drawn.wi, wo)) * drawn.wi.z() / drawn.pdf;
    return drawn;
  }

  /// Returns the density in sr^-1 with which `sample` draws wi, anywhere on the sphere.
  [[nodiscard]] double pdf(const direction& wi, const direction& wo) const noexcept {
    return is_above_horizon(wo) ? mixture_.pdf(wi, wo) : 0.0;
  }

 private:
  [[nodiscard]] static bool is_above_horizon(const direction& wo) noexcept { return wo.z() > 0.0 && wo.allFinite(); }

  Brdf f_;
  detail::direction_mixture mixture_;
};

static_assert(direction_sampler<lobe_sampler<lambertian>> && direction_sampler<lobe_sampler<ward>>);
static_assert(direction_sampler<lobe_sampler<sum_of_lobes<lambertian, ggx>>>);

/// The sampler of a fitted model.
using analytic_sampler = lobe_sampler<analytic_brdf>;

static_assert(direction_sampler<analytic_sampler>);

}  // namespace gonio::model

#if !defined(GONIO_COMPILED)
#include <gonio/model/impl/lobe_sampler.ipp>
#endif
