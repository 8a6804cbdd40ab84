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

GONIO_INLINE rough_surface as_ggx_surface(const model::analytic_brdf& model, const char* renderer) {
  const rough_surface surface = as_rough_surface(model);
  if (surface.beckmann) gonio::refuse({renderer, " has no Beckmann distribution: fit ggx instead of torrance-sparrow"});
  return surface;
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE std::string pbrt_material(const model::analytic_brdf& model) {
  const detail::rough_surface surface = detail::as_ggx_surface(model, "pbrt");
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

GONIO_INLINE std::string materialx_material(const model::analytic_brdf& model, const std::string& name) {
  const detail::rough_surface surface = detail::as_ggx_surface(model, "OpenPBR");
  constexpr const char* known = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_";
  if (name.empty() || name.find_first_not_of(known) != std::string::npos)
    gonio::refuse({"the name of a MaterialX material is letters, digits and underscores, not ", detail::quoted(name)});
  const auto input = [](const char* of, const char* type, const std::string& value) {
    return "    <input name=\"" + std::string(of) + "\" type=\"" + type + "\" value=\"" + value + "\"/>\n";
  };
  const auto colour = [&](const char* of, const rgb& value) {
    return input(of, "color3", detail::three_numbers(value.min(1.0), ", "));
  };
  std::string text =
      "<?xml version=\"1.0\"?>\n<materialx version=\"1.39\" colorspace=\"lin_rec709\">\n"
      "  <open_pbr_surface name=\"" +
      name + "_surface\" type=\"surfaceshader\">\n";
  text += input("base_weight", "float", "1");
  text += colour("base_color", surface.metal() ? rgb(surface.specular * surface.f0) : surface.diffuse);
  text += input("base_metalness", "float", surface.metal() ? "1" : "0");
  text += input("specular_roughness", "float", detail::shortest(std::sqrt(surface.alpha)));
  if (!surface.metal()) {
    text += colour("specular_color", surface.specular);
    text += input("specular_ior", "float", detail::shortest(surface.refractive_index()));
  }
  return text + "  </open_pbr_surface>\n  <surfacematerial name=\"" + name + "\" type=\"material\">\n" +
         "    <input name=\"surfaceshader\" type=\"surfaceshader\" nodename=\"" + name + "_surface\"/>\n" +
         "  </surfacematerial>\n</materialx>\n";
}

GONIO_INLINE std::string gltf_material(const model::analytic_brdf& model) {
  const detail::rough_surface surface = detail::as_ggx_surface(model, "glTF");
  const rgb base = surface.metal() ? rgb(surface.specular * surface.f0) : surface.diffuse;
  const std::string core =
      "      \"pbrMetallicRoughness\": {\n        \"baseColorFactor\": [" + detail::three_numbers(base.min(1.0), ", ") +
      ", 1],\n        \"metallicFactor\": " + (surface.metal() ? "1" : "0") +
      ",\n        \"roughnessFactor\": " + detail::shortest(std::sqrt(std::min(surface.alpha, 1.0))) + "\n      }";
  const std::string begin = "{\n  \"asset\": {\"version\": \"2.0\", \"generator\": \"gonio\"},\n";
  const std::string materials = "  \"materials\": [\n    {\n" + core;
  const std::string end = "\n    }\n  ]\n}\n";
  if (surface.metal()) return begin + materials + end;
  // f0 and f90 are multiplied by the factor, f0 alone by the colour.
  const double factor = std::min(surface.specular.maxCoeff(), 1.0);
  const rgb colour = factor > 0.0 ? rgb(surface.specular / factor) : rgb(rgb::Ones());
  return begin + "  \"extensionsUsed\": [\"KHR_materials_ior\", \"KHR_materials_specular\"],\n" + materials +
         ",\n      \"extensions\": {\n        \"KHR_materials_ior\": {\"ior\": " +
         detail::shortest(surface.refractive_index()) +
         "},\n        \"KHR_materials_specular\": {\"specularFactor\": " + detail::shortest(factor) +
         ", \"specularColorFactor\": [" + detail::three_numbers(colour, ", ") + "]}\n      }" + end;
}

}  // namespace gonio::io
