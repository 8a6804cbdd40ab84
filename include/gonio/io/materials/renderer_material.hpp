#pragma once
/// Fitted models as text materials of renderers: pbrt-v4, Mitsuba 3, OpenPBR in MaterialX, glTF 2.0, and the Open
/// Shading Language.

#include <gonio/io/bytes/file.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/model/analytic_brdf.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

namespace gonio::io {

namespace detail {

/// The parameters of a renderer's material: one rough interface over a diffuse base.
struct rough_surface {
  rgb diffuse = rgb::Zero();
  rgb specular = rgb::Zero();
  double alpha = 0.0, f0 = 0.0;
  bool beckmann = false;

  /// Returns the refractive index whose reflectance at normal incidence is f0.
  [[nodiscard]] double refractive_index() const;
  /// Returns the reflectance of the highlight at normal incidence.
  [[nodiscard]] rgb highlight() const { return specular * f0; }
  /// Returns 1 if the base is negligible, 0 for a highlight of at most 0.3 (a dielectric), otherwise the highlight's
  /// fraction of the reflected light.
  [[nodiscard]] double metalness() const;
  /// Returns the common colour of a metal and its base. The highlight at normal incidence is `metalness` times this
  /// colour.
  [[nodiscard]] rgb metal_colour() const;
};

/// Returns a surface with the same highlight at normal incidence and no specular colour above 1, as renderers need.
[[nodiscard]] rough_surface bounded(rough_surface surface);

struct conductor {
  double index = 1.0, extinction = 0.0;
};

/// Returns the conductor (dielectric if the extinction is 0) that reflects f0 at normal incidence and is nearest to
/// Schlick's approximation up to 85 degrees. Conductor and approximation differ by at most 0.5 % if f0 is 0.6 or more,
/// by 31 % if f0 is 0.03.
[[nodiscard]] conductor conductor_like_schlick(double f0);

/// Returns the albedo, at most 1, of a Lambertian base that has the albedo `seen` through a smooth dielectric coat in
/// diffuse light. Includes the light that the coat reflects back inside. J. L. Saunderson, "Calculation of the Color of
/// Pigmented Plastics", JOSA 32(12), 1942 (doi:10.1364/JOSA.32.000727), with Fresnel's equations for diffuse light.
[[nodiscard]] rgb base_below_coat(const rgb& seen, double index);

/// Returns the model's surface. Throws gonio::error unless the model is one lobe of GGX or Torrance-Sparrow, with or
/// without a Lambertian lobe.
[[nodiscard]] rough_surface as_rough_surface(const model::analytic_brdf& model);

/// Returns the same surface as `as_rough_surface`, but also throws gonio::error for Torrance-Sparrow, whose Beckmann
/// distribution `renderer` lacks.
[[nodiscard]] rough_surface as_ggx_surface(const model::analytic_brdf& model, const char* renderer);

[[nodiscard]] inline std::string three_numbers(const rgb& colour, const std::string& between) {
  return shortest(colour[0]) + between + shortest(colour[1]) + between + shortest(colour[2]);
}

}  // namespace detail

/// Returns a `Material` of pbrt-v4, linear sRGB. GGX with Lambert becomes `coateddiffuse` with the same roughness (not
/// remapped) and refractive index. Seen in diffuse light through the coat, which does not absorb, its base has the
/// model's albedo. The highlight's colour is lost, because the coat has none. GGX alone becomes `conductor` with the
/// reflectance at normal incidence, colour times f0. A highlight above 0.3 (no dielectric has one) with a base becomes
/// a `mix` of `conductor` and `diffuse`. Throws gonio::error for other models: pbrt has no Beckmann distribution.
[[nodiscard]] std::string pbrt_material(const model::analytic_brdf& model);

/// Returns a `bsdf` of Mitsuba 3, linear sRGB: the sum of the lobes, as a `blendbsdf` in equal parts of a `diffuse` and
/// a `roughconductor` with doubled colours. All parameters are kept; the rise towards grazing angles is Fresnel's for
/// `conductor_like_schlick` instead of Schlick's. `roughplastic` is not used: it loses a sixth of the base's light.
[[nodiscard]] std::string mitsuba_material(const model::analytic_brdf& model);

/// Returns a MaterialX 1.39 document (.mtlx) with an `open_pbr_surface`, linear Rec. 709: OpenPBR 1.1, whose roughness
/// is the square root of GGX's. GGX with Lambert keeps albedo, roughness, refractive index and, as `specular_color`,
/// the colour of the highlight at normal incidence; the base receives only the light that the interface transmits. GGX
/// alone becomes a metal with the colour times f0. A highlight above 0.3 with a base becomes a metal with
/// `base_metalness` below 1, whose base has the same colour. Throws gonio::error for other models, and for a name that
/// is not letters, digits and underscores.
[[nodiscard]] std::string materialx_material(const model::analytic_brdf& model, const std::string& name = "material");

/// Returns a glTF 2.0 document with the material on a unit sphere, which importers show. The material is
/// metallic-roughness, whose roughness is the square root of GGX's; a dielectric with a base also has KHR_materials_ior
/// and KHR_materials_specular. The highlight then keeps its colour at normal incidence; at grazing angles it is grey,
/// the colour's largest channel, at most 1. Metals are as in OpenPBR. Throws gonio::error unless the model is GGX or
/// GGX plus Lambert.
[[nodiscard]] std::string gltf_material(const model::analytic_brdf& model);

/// Returns a shader `gonio_material` in the Open Shading Language for Blender's Cycles, linear Rec. 709: the sum of a
/// diffuse closure and `generalized_schlick_bsdf` with the model's parameters. The shader differs from the model only
/// in the masking: Cycles' is height-correlated. Throws gonio::error unless the model is GGX or GGX plus Lambert.
[[nodiscard]] std::string osl_shader(const model::analytic_brdf& model);

/// Writes a material's text to a file, completely or not at all.
inline void write_renderer_material(const std::filesystem::path& path, const std::string& material) {
  write_atomically(path, std::as_bytes(std::span(material)));
}

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/materials/impl/renderer_material.ipp>
#endif
