#pragma once
/// Fitted models as materials of renderers, text: pbrt-v4, Mitsuba 3, OpenPBR in MaterialX, glTF 2.0, and the Open
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

/// What a renderer's material of one rough interface over a diffuse base is told.
struct rough_surface {
  rgb diffuse = rgb::Zero();
  rgb specular = rgb::Zero();
  double alpha = 0.0, f0 = 0.0;
  bool beckmann = false;

  /// The refractive index whose reflectance at normal incidence is f0.
  [[nodiscard]] double refractive_index() const;
  /// What the highlight reflects at normal incidence.
  [[nodiscard]] rgb highlight() const { return specular * f0; }
  /// The share of the highlight in all that is reflected, where it is that of a metal: 1 if no base is seen beside it,
  /// 0 for a dielectric.
  [[nodiscard]] double metalness() const;
  /// The colour that a metal and its base share: a share `metalness` of it is the highlight at normal incidence.
  [[nodiscard]] rgb metal_colour() const;
};

/// The same highlight at normal incidence with no colour above 1, for renderers that refuse such.
[[nodiscard]] rough_surface bounded(rough_surface surface);

struct conductor {
  double index = 1.0, extinction = 0.0;
};

/// A conductor, or without extinction a dielectric, that reflects f0 at normal incidence, and of these the one nearest
/// to Schlick's approximation up to 85 degrees: within 0.5 % from f0 = 0.6, within 31 % for a dielectric's 0.03.
[[nodiscard]] conductor conductor_like_schlick(double f0);

/// The albedo of a Lambertian base that has the albedo `seen` in diffuse light through a smooth dielectric, at most 1:
/// what the dielectric reflects back inside counts. J. L. Saunderson, "Calculation of the Color of Pigmented Plastics",
/// JOSA 32(12), 1942 (doi:10.1364/JOSA.32.000727), with what diffuse light meets by Fresnel's equations.
[[nodiscard]] rgb base_below_coat(const rgb& seen, double index);

/// Throws gonio::error unless the model is one lobe of GGX or Torrance-Sparrow, beside a Lambertian one or not.
[[nodiscard]] rough_surface as_rough_surface(const model::analytic_brdf& model);

/// The same, and throws for Beckmann's distribution, naming who has none.
[[nodiscard]] rough_surface as_ggx_surface(const model::analytic_brdf& model, const char* renderer);

[[nodiscard]] inline std::string three_numbers(const rgb& colour, const std::string& between) {
  return shortest(colour[0]) + between + shortest(colour[1]) + between + shortest(colour[2]);
}

}  // namespace detail

/// A `Material` of pbrt-v4, linear sRGB. GGX beside Lambert becomes `coateddiffuse`: roughness (not remapped) and
/// refractive index are carried over, and a base that has the albedo in diffuse light below a coat that absorbs
/// nothing; the colour of the highlight is not, because the coat has none. GGX by itself becomes `conductor` with the
/// reflectance at normal incidence, colour times f0, and so does a highlight that no dielectric has, above 0.3: beside
/// a base, a `mix` of both. Throws gonio::error for other models: pbrt has no Beckmann distribution.
[[nodiscard]] std::string pbrt_material(const model::analytic_brdf& model);

/// A `bsdf` of Mitsuba 3, linear sRGB: the sum of the lobes, as a `blendbsdf` of equal shares of a `diffuse` and a
/// `roughconductor` of twice the colours. All is carried over; the rise towards grazing angles is Fresnel's, of
/// `conductor_like_schlick`, instead of Schlick's. `roughplastic` is not used: it takes a sixth of the base's light.
[[nodiscard]] std::string mitsuba_material(const model::analytic_brdf& model);

/// A MaterialX 1.39 document (.mtlx) with an `open_pbr_surface`, linear Rec. 709: OpenPBR 1.1, whose roughness is the
/// root of GGX's. GGX beside Lambert carries over albedo, roughness, refractive index and, as `specular_color`, the
/// colour of the highlight at normal incidence; the base has only the light that the interface lets through. GGX by
/// itself becomes a metal in the colour times f0; a highlight above 0.3 beside a base becomes one with a
/// `base_metalness` below 1, whose base has the same colour. Throws gonio::error for other models, and for a name that
/// is not letters, digits and underscores.
[[nodiscard]] std::string materialx_material(const model::analytic_brdf& model, const std::string& name = "material");

/// A glTF 2.0 document with a unit sphere of one material, which importers show: metallic-roughness, whose roughness is
/// the root of GGX's, with KHR_materials_ior and KHR_materials_specular where there is a base. There the highlight has
/// its colour at normal incidence, and its largest channel, at most 1, at grazing angles. Metals are those of OpenPBR.
/// Throws gonio::error for models but GGX, beside Lambert or by itself.
[[nodiscard]] std::string gltf_material(const model::analytic_brdf& model);

/// A shader `gonio_material` in the Open Shading Language for Blender's Cycles, linear Rec. 709: the sum of a diffuse
/// closure and `generalized_schlick_bsdf`, whose parameters begin as the model's. Only masking differs: Cycles' knows
/// that both directions see the same heights. Throws gonio::error for models but GGX, beside Lambert or by itself.
[[nodiscard]] std::string osl_shader(const model::analytic_brdf& model);

/// Writes such a text; whole, or not at all.
inline void write_renderer_material(const std::filesystem::path& path, const std::string& material) {
  write_atomically(path, std::as_bytes(std::span(material)));
}

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/materials/impl/renderer_material.ipp>
#endif
