#pragma once
/// A material's interface for a renderer: `eval`, `eval_pdf` and `sample`, with standard library types only. This
/// header includes no other gonio header and also compiles as C++17, so a renderer's own files need neither Eigen nor
/// the rest of the library: one file makes the material, and all other files use a `bsdf_view`. docs/learn/renderer.md
/// has recipes for pbrt-v4, Mitsuba 3 and Cycles.

#include <array>

namespace gonio::render {

/// A view of any material that samples itself, such as `half_vector_sampler` or `lobe_sampler`: four pointers. The
/// material must outlive it. It does not allocate, lock or throw.
///
/// All directions are unit vectors that point away from the surface, in its local frame with z along the normal: wi
/// towards the light, wo towards the viewer. Values are linear Rec. 709 (sRGB without its curve), in sr^-1.
class bsdf_view {
 public:
  using vector = std::array<float, 3>;
  using colour = std::array<float, 3>;

  /// A direction wi towards the light with its density `pdf` in sr^-1 and the weight f cos(theta_i) / pdf. It carries
  /// light if `pdf` is positive and the weight is not black.
  struct sampled {
    vector wi{0.0f, 0.0f, 1.0f};
    colour weight{};
    float pdf = 0.0f;
  };

  template <class Sampler>
  explicit bsdf_view(const Sampler& material) noexcept
      : material_(&material),
        eval_(&value_of<Sampler>),
        eval_pdf_(&density_of<Sampler>),
        sample_(&drawn_from<Sampler>) {}
  /// Deleted, because a view must not outlive its material.
  template <class Sampler>
  explicit bsdf_view(const Sampler&&) = delete;

  /// Returns f without the cosine. Black below the horizon and for NaN components.
  [[nodiscard]] colour eval(const vector& wi, const vector& wo) const noexcept { return eval_(material_, wi, wo); }

  /// Returns the density in sr^-1 with which `sample` draws wi.
  [[nodiscard]] float eval_pdf(const vector& wi, const vector& wo) const noexcept {
    return eval_pdf_(material_, wi, wo);
  }

  /// Draws a direction towards the light from two numbers in [0, 1).
  [[nodiscard]] sampled sample(const vector& wo, float u1, float u2) const noexcept {
    return sample_(material_, wo, u1, u2);
  }

 private:
  template <class Sampler>
  using vector_of = typename Sampler::vector;

  template <class Sampler>
  [[nodiscard]] static vector_of<Sampler> to_own(const vector& w) noexcept {
    return {w[0], w[1], w[2]};
  }
  template <class Vector>
  [[nodiscard]] static std::array<float, 3> to_array(const Vector& v) noexcept {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
  }

  template <class Sampler>
  [[nodiscard]] static colour value_of(const void* material, const vector& wi, const vector& wo) noexcept {
    return to_array(static_cast<const Sampler*>(material)->brdf()(to_own<Sampler>(wi), to_own<Sampler>(wo)));
  }
  template <class Sampler>
  [[nodiscard]] static float density_of(const void* material, const vector& wi, const vector& wo) noexcept {
    return static_cast<float>(static_cast<const Sampler*>(material)->pdf(to_own<Sampler>(wi), to_own<Sampler>(wo)));
  }
  template <class Sampler>
  [[nodiscard]] static sampled drawn_from(const void* material, const vector& wo, float u1, float u2) noexcept {
    const auto drawn = static_cast<const Sampler*>(material)->sample(to_own<Sampler>(wo), u1, u2);
    return {to_array(drawn.wi), to_array(drawn.weight), static_cast<float>(drawn.pdf)};
  }

  const void* material_;
  colour (*eval_)(const void*, const vector&, const vector&) noexcept;
  float (*eval_pdf_)(const void*, const vector&, const vector&) noexcept;
  sampled (*sample_)(const void*, const vector&, float, float) noexcept;
};

}  // namespace gonio::render
