#pragma once
/// Evaluates the BRDFs of a map's texels (io/materials/svbrdf_map.hpp) from their weights, as `component_brdf`
/// evaluates a single material. Nielsen et al. 2015 (doi:10.1145/2816795.2818085), Eq. 10.

#include <gonio/core/half.hpp>
#include <gonio/render/component_brdf.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <span>

namespace gonio::render {

/// A view of the shared components and of all texels' weights, which must outlive it. The weights may be in a
/// memory-mapped file. Evaluation does not allocate, lock or throw.
/// ```cpp
/// const gonio::io::svbrdf_map map("map.gsv");
/// const gonio::render::shared_components<Eigen::half> functions(prior, map.header().functions);
/// const gonio::io::svbrdf_band band = map.read_band(0);
/// const gonio::render::texel_brdf sample(functions, band.weights);
/// const auto value = sample(texel, wi, wo);
/// ```
template <stored_number Stored = float, interpolation Interpolation = interpolation::trilinear>
class texel_brdf {
 public:
  /// The largest number of components; larger priors are not in use.
  static constexpr Eigen::Index most_components = 512;

  /// `weights` are half floats: for each texel the weights of red, then of green, then of blue. Throws gonio::error if
  /// their number does not fit, or if there are too many components.
  texel_brdf(const shared_components<Stored>& components, std::span<const std::uint16_t> weights)
      : components_(&components), weights_(weights) {
    if (components.size() > most_components)
      refuse({"texels of ", components.size(), " components, expected at most ", most_components});
    if (std::ssize(weights) % (3 * components.size()) != 0)
      refuse({"texels of ", components.size(), " components need 3 weights for each component: ", std::ssize(weights),
              " weights are not a whole number of texels"});
  }

  [[nodiscard]] Eigen::Index texels() const noexcept { return std::ssize(weights_) / (3 * components_->size()); }

  /// Returns the reflectance in sr^-1 of a texel for a pair of unit vectors, `float` or `double`. Black where
  /// `component_brdf` is black, and for a texel outside of the sample, whose weights are all zero.
  template <std::floating_point Real>
  [[nodiscard]] Eigen::Array<Real, 3, 1> operator()(Eigen::Index texel, const Eigen::Matrix<Real, 3, 1>& wi,
                                                    const Eigen::Matrix<Real, 3, 1>& wo) const noexcept {
    GONIO_ASSERT(texel >= 0 && texel < texels());
    const Eigen::Index k = components_->size();
    // Interleave the three weights of each component, as in component_brdf.
    std::array<float, 3 * most_components> own;
    const std::uint16_t* const stored = weights_.data() + 3 * k * texel;
    if (std::all_of(stored, stored + 3 * k, [](std::uint16_t each) { return each == 0; }))
      return Eigen::Array<Real, 3, 1>::Zero();
    for (Eigen::Index c = 0; c < 3; ++c)
      for (Eigen::Index i = 0; i < k; ++i) own[3 * i + c] = from_half(stored[c * k + i]);
    return detail::evaluate_components<Interpolation>(*components_, own.data(), wi, wo);
  }

 private:
  const shared_components<Stored>* components_;
  std::span<const std::uint16_t> weights_;
};

}  // namespace gonio::render
