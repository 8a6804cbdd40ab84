#pragma once
/// Bodies of io/renderer_material.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/io/file.hpp>
#include <gonio/io/renderer_material.hpp>
#include <gonio/io/text.hpp>
#include <gonio/model/analytic_brdf.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

namespace gonio::io::detail {

GONIO_INLINE double rough_surface::refractive_index() const {
  const double root = std::sqrt(std::min(f0, 0.5));
  return (1.0 + root) / (1.0 - root);
}

GONIO_INLINE bool rough_surface::metal() const { return (diffuse == 0.0).all(); }

GONIO_INLINE rough_surface as_rough_surface(const model::analytic_brdf& model) {
  rough_surface found;
  std::size_t rough = 0;
  for (const model::analytic_lobe& lobe : model.lobes()) {
    if (lobe.kind() == model::lobe_kind::of<model::lambert_shape>()) {
      found.diffuse += lobe.colour();
      continue;
    }
    found.beckmann = lobe.kind() == model::lobe_kind::of<model::torrance_sparrow_shape>();
    if (!found.beckmann && !(lobe.kind() == model::lobe_kind::of<model::ggx_shape>()))
      gonio::refuse({"renderers know the lobes ggx and torrance-sparrow beside a diffuse one, not ",
                     std::string(lobe.kind().name())});
    found.specular = lobe.colour();
    found.alpha = lobe.parameters()[0];
    found.f0 = lobe.parameters()[1];
    ++rough;
  }
  if (rough != 1) gonio::refuse({"a renderer's material has one rough lobe, not ", rough});
  return found;
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE std::string pbrt_material(const model::analytic_brdf& model) {
  const detail::rough_surface surface = detail::as_rough_surface(model);
  if (surface.beckmann) gonio::refuse("pbrt has no Beckmann distribution: fit ggx instead of torrance-sparrow");
  const std::string roughness =
      "  \"float roughness\" [ " + detail::shortest(surface.alpha) + " ]\n  \"bool remaproughness\" false\n";
  if (surface.metal())
    return "Material \"conductor\"\n  \"rgb reflectance\" [ " +
           detail::three_numbers((surface.specular * surface.f0).min(1.0), " ") + " ]\n" + roughness;
  return "Material \"coateddiffuse\"\n  \"rgb reflectance\" [ " + detail::three_numbers(surface.diffuse.min(1.0), " ") +
         " ]\n" + roughness + "  \"float eta\" [ " + detail::shortest(surface.refractive_index()) + " ]\n";
}

GONIO_INLINE std::string mitsuba_material(const model::analytic_brdf& model) {
  const detail::rough_surface surface = detail::as_rough_surface(model);
  const auto colour = [](const char* name, const rgb& value) {
    return "  <rgb name=\"" + std::string(name) + "\" value=\"" + detail::three_numbers(value, ", ") + "\"/>\n";
  };
  std::string text = surface.metal() ? "<bsdf type=\"roughconductor\">\n  <string name=\"material\" value=\"none\"/>\n"
                                     : "<bsdf type=\"roughplastic\">\n";
  text += "  <string name=\"distribution\" value=\"" + std::string(surface.beckmann ? "beckmann" : "ggx") + "\"/>\n";
  text += "  <float name=\"alpha\" value=\"" + detail::shortest(surface.alpha) + "\"/>\n";
  if (surface.metal()) return text + colour("specular_reflectance", surface.specular * surface.f0) + "</bsdf>\n";
  text += "  <float name=\"int_ior\" value=\"" + detail::shortest(surface.refractive_index()) + "\"/>\n";
  text += "  <float name=\"ext_ior\" value=\"1\"/>\n";
  return text + colour("diffuse_reflectance", surface.diffuse) + colour("specular_reflectance", surface.specular) +
         "</bsdf>\n";
}

}  // namespace gonio::io
