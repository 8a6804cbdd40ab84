#pragma once
/// Bodies of io/materials/renderer_material.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/fresnel.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/materials/renderer_material.hpp>
#include <gonio/io/text/base64.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/model/analytic_brdf.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <vector>

namespace gonio::io::detail {

GONIO_INLINE double rough_surface::refractive_index() const {
  const double root = std::sqrt(std::min(f0, 0.999));
  return (1.0 + root) / (1.0 - root);
}

GONIO_INLINE double rough_surface::metalness() const {
  constexpr double base_of_metal = 0.05, largest_of_dielectrics = 0.3;  // rutile, a dielectric, has 0.21
  if ((diffuse <= base_of_metal * highlight()).all()) return 1.0;
  if (highlight().maxCoeff() <= largest_of_dielectrics) return 0.0;
  return highlight().sum() / (highlight() + diffuse).sum();
}

GONIO_INLINE rgb rough_surface::metal_colour() const {
  return (metalness() < 1.0 ? rgb(highlight() + diffuse) : highlight()).min(1.0);
}

GONIO_INLINE rough_surface bounded(rough_surface surface) {
  const double brightest = surface.specular.maxCoeff();
  if (brightest <= 1.0) return surface;
  surface.specular /= brightest;
  surface.f0 = std::min(brightest * surface.f0, 0.999);
  return surface;
}

GONIO_INLINE rgb base_below_coat(const rgb& seen, double index) {
  // Integrate the fraction of diffuse light that enters a dielectric; reciprocity gives the fraction that leaves it.
  constexpr int steps = 1000;
  double enters = 0.0;
  for (int step = 0; step < steps; ++step) {
    const double cosine = (step + 0.5) / steps;
    enters += (1.0 - fresnel_dielectric(cosine, index)) * 2.0 * cosine / steps;
  }
  const double leaves = enters / (index * index);
  return (seen / (enters * leaves + seen * (1.0 - leaves))).min(1.0);
}

GONIO_INLINE conductor conductor_like_schlick(double f0) {
  const double bounded = std::clamp(f0, 1e-4, 0.999), root = std::sqrt(bounded);
  const double least = (1.0 - bounded) / (1.0 + bounded), most = (1.0 + root) / (1.0 - root);
  conductor best;
  double least_error = std::numeric_limits<double>::infinity();
  constexpr int steps = 400;
  for (int step = 0; step <= steps; ++step) {
    // For every index in this range some extinction gives this reflectance at normal incidence.
    const double index = least * std::pow(most / least, static_cast<double>(step) / steps);
    const double squared = (bounded * std::pow(index + 1.0, 2) - std::pow(index - 1.0, 2)) / (1.0 - bounded);
    const double extinction = std::sqrt(std::max(squared, 0.0));
    double error = 0.0;
    for (int degrees = 0; degrees <= 85; degrees += 5) {
      const double cosine = std::cos(radians(degrees));
      const double ratio = fresnel_conductor(cosine, index, extinction) / fresnel_schlick(cosine, bounded);
      error = std::max(error, std::abs(ratio - 1.0));
    }
    if (error >= least_error) continue;
    least_error = error;
    best = {index, extinction};
  }
  return best;
}

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
      gonio::refuse(
          {"renderers support a diffuse lobe and ggx or torrance-sparrow, not ", std::string(lobe.kind().name())});
    found.specular = lobe.colour();
    found.alpha = lobe.parameters()[0];
    found.f0 = lobe.parameters()[1];
    ++rough;
  }
  if (rough != 1) gonio::refuse({"a renderer's material needs one rough lobe, not ", rough});
  return found;
}

GONIO_INLINE rough_surface as_ggx_surface(const model::analytic_brdf& model, const char* renderer) {
  const rough_surface surface = as_rough_surface(model);
  if (surface.beckmann) gonio::refuse({renderer, " has no Beckmann distribution: fit ggx instead of torrance-sparrow"});
  return surface;
}

/// Returns the part of a glTF document that describes a scene: a unit sphere with the first material.
[[nodiscard]] GONIO_INLINE std::string gltf_sphere() {
  constexpr int columns = 32, rows = 16;
  std::vector<float> points;
  std::vector<std::uint16_t> corners;
  for (int row = 0; row <= rows; ++row)
    for (int column = 0; column <= columns; ++column) {
      const direction at =
          spherical_direction(std::numbers::pi * row / rows, 2.0 * std::numbers::pi * column / columns);
      for (const double coordinate : {at.x(), at.z(), -at.y()}) points.push_back(static_cast<float>(coordinate));
    }
  const auto add = [&](int a, int b, int c) {
    for (const int corner : {a, b, c}) corners.push_back(static_cast<std::uint16_t>(corner));
  };
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const int above = row * (columns + 1) + column, below = above + columns + 1;
      if (row + 1 < rows) add(above, below, below + 1);
      if (row > 0) add(above, below + 1, above + 1);
    }
  std::vector<std::byte> bytes(4 * points.size() + 2 * corners.size());
  std::memcpy(bytes.data(), points.data(), 4 * points.size());
  std::memcpy(bytes.data() + 4 * points.size(), corners.data(), 2 * corners.size());
  return message_of(
      {"  \"scene\": 0,\n  \"scenes\": [{\"nodes\": [0]}],\n  \"nodes\": [{\"mesh\": 0}],\n"
       "  \"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0, \"NORMAL\": 0}, \"indices\": 1, "
       "\"material\": 0}]}],\n"
       "  \"accessors\": [\n    {\"bufferView\": 0, \"componentType\": 5126, \"type\": \"VEC3\", \"count\": ",
       points.size() / 3,
       ", \"min\": [-1, -1, -1], \"max\": [1, 1, 1]},\n"
       "    {\"bufferView\": 1, \"componentType\": 5123, \"type\": \"SCALAR\", \"count\": ",
       corners.size(), "}\n  ],\n  \"bufferViews\": [\n    {\"buffer\": 0, \"byteLength\": ", 4 * points.size(),
       ", \"target\": 34962},\n    {\"buffer\": 0, \"byteOffset\": ", 4 * points.size(), ", \"byteLength\": ",
       2 * corners.size(), ", \"target\": 34963}\n  ],\n  \"buffers\": [{\"byteLength\": ", bytes.size(),
       ", \"uri\": \"", data_url("application/octet-stream", bytes), "\"}],\n"});
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE std::string pbrt_material(const model::analytic_brdf& model) {
  const detail::rough_surface surface = detail::bounded(detail::as_ggx_surface(model, "pbrt"));
  const std::string roughness =
      "  \"float roughness\" [ " + shortest(surface.alpha) + " ]\n  \"bool remaproughness\" false\n";
  const auto reflectance = [](const rgb& value) {
    return "  \"rgb reflectance\" [ " + detail::three_numbers(value.min(1.0), " ") + " ]\n";
  };
  const double metalness = surface.metalness();
  if (metalness == 1.0) return "Material \"conductor\"\n" + reflectance(surface.highlight()) + roughness;
  if (metalness > 0.0)  // pbrt picks one of the two materials at random
    return "MakeNamedMaterial \"base\"\n  \"string type\" \"diffuse\"\n" +
           reflectance(surface.diffuse / (1.0 - metalness)) +
           "MakeNamedMaterial \"metal\"\n  \"string type\" \"conductor\"\n" +
           reflectance(surface.highlight() / metalness) + roughness +
           "Material \"mix\"\n  \"string materials\" [ \"base\" \"metal\" ]\n  \"float amount\" [ " +
           shortest(metalness) + " ]\n";
  // A coat of nonzero thickness would absorb light. Below a coat of high index, pbrt's default of ten bounces is too
  // few.
  const double index = surface.refractive_index();
  return "Material \"coateddiffuse\"\n" + reflectance(detail::base_below_coat(surface.diffuse, index)) + roughness +
         "  \"float eta\" [ " + shortest(index) + " ]\n  \"float thickness\" [ 0 ]\n  \"integer maxdepth\" [ 100 ]\n";
}

GONIO_INLINE std::string mitsuba_material(const model::analytic_brdf& model) {
  const detail::rough_surface surface = detail::as_rough_surface(model);
  const auto number = [](const char* type, const char* name, double value) {
    return "<" + std::string(type) + " name=\"" + name + "\" value=\"" + shortest(value) + "\"/>\n";
  };
  // Mitsuba refuses colours above 1 unless they are marked as unbounded.
  const auto colour = [](const char* name, const rgb& value) {
    return "<spectrum type=\"srgb\" name=\"" + std::string(name) + "\">\n      <rgb name=\"color\" value=\"" +
           detail::three_numbers(value, ", ") +
           "\"/>\n      <boolean name=\"unbounded\" value=\"true\"/>\n    </spectrum>\n";
  };
  // The sum of two lobes is a blend, in equal parts, of these lobes with doubled brightness.
  const auto [index, extinction] = detail::conductor_like_schlick(surface.f0);
  return "<bsdf type=\"blendbsdf\">\n  " + number("float", "weight", 0.5) + "  <bsdf type=\"diffuse\">\n    " +
         colour("reflectance", 2.0 * surface.diffuse) + "  </bsdf>\n  <bsdf type=\"roughconductor\">\n    " +
         "<string name=\"distribution\" value=\"" + (surface.beckmann ? "beckmann" : "ggx") + "\"/>\n    " +
         number("float", "alpha", surface.alpha) + "    " + number("spectrum", "eta", index) + "    " +
         number("spectrum", "k", extinction) + "    " + colour("specular_reflectance", 2.0 * surface.specular) +
         "  </bsdf>\n</bsdf>\n";
}

GONIO_INLINE std::string materialx_material(const model::analytic_brdf& model, const std::string& name) {
  const detail::rough_surface surface = detail::bounded(detail::as_ggx_surface(model, "OpenPBR"));
  constexpr const char* known = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_";
  if (name.empty() || name.find_first_not_of(known) != std::string::npos)
    gonio::refuse({"the name of a MaterialX material needs letters, digits and underscores, not ", in_quotes(name)});
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
  const double metalness = surface.metalness();
  text += colour("base_color", metalness > 0.0 ? surface.metal_colour() : surface.diffuse);
  text += input("base_metalness", "float", shortest(metalness));
  text += input("specular_roughness", "float", shortest(std::sqrt(surface.alpha)));
  if (metalness == 0.0) text += colour("specular_color", surface.specular);
  // If the metalness is between 0 and 1, index 1 removes the highlight that the base would have of its own.
  if (metalness < 1.0)
    text += input("specular_ior", "float", metalness > 0.0 ? "1" : shortest(surface.refractive_index()));
  return text + "  </open_pbr_surface>\n  <surfacematerial name=\"" + name + "\" type=\"material\">\n" +
         "    <input name=\"surfaceshader\" type=\"surfaceshader\" nodename=\"" + name + "_surface\"/>\n" +
         "  </surfacematerial>\n</materialx>\n";
}

GONIO_INLINE std::string gltf_material(const model::analytic_brdf& model) {
  const detail::rough_surface surface = detail::as_ggx_surface(model, "glTF");
  const double metalness = surface.metalness();
  const rgb base = metalness > 0.0 ? surface.metal_colour() : surface.diffuse;
  const std::string core =
      "      \"pbrMetallicRoughness\": {\n        \"baseColorFactor\": [" + detail::three_numbers(base.min(1.0), ", ") +
      ", 1],\n        \"metallicFactor\": " + shortest(metalness) +
      ",\n        \"roughnessFactor\": " + shortest(std::sqrt(std::min(surface.alpha, 1.0))) + "\n      }";
  const std::string begin =
      "{\n  \"asset\": {\"version\": \"2.0\", \"generator\": \"gonio\"},\n" + detail::gltf_sphere();
  const std::string materials = "  \"materials\": [\n    {\n" + core;
  const std::string end = "\n    }\n  ]\n}\n";
  if (metalness == 1.0) return begin + materials + end;
  if (metalness > 0.0)
    return begin + "  \"extensionsUsed\": [\"KHR_materials_ior\"],\n" + materials +
           ",\n      \"extensions\": {\"KHR_materials_ior\": {\"ior\": 1}}" + end;
  // glTF's specular factor scales f0 and f90, its specular colour only f0.
  const double factor = std::min(surface.specular.maxCoeff(), 1.0);
  const rgb colour = factor > 0.0 ? rgb(surface.specular / factor) : rgb(rgb::Ones());
  return begin + "  \"extensionsUsed\": [\"KHR_materials_ior\", \"KHR_materials_specular\"],\n" + materials +
         ",\n      \"extensions\": {\n        \"KHR_materials_ior\": {\"ior\": " +
         shortest(surface.refractive_index()) +
         "},\n        \"KHR_materials_specular\": {\"specularFactor\": " + shortest(factor) +
         ", \"specularColorFactor\": [" + detail::three_numbers(colour, ", ") + "]}\n      }" + end;
}

GONIO_INLINE std::string osl_shader(const model::analytic_brdf& model) {
  const detail::rough_surface surface = detail::as_ggx_surface(model, "Cycles' Schlick closure");
  const auto colour = [](const char* name, const rgb& value) {
    return "color " + std::string(name) + " = color(" + detail::three_numbers(value, ", ") + ")";
  };
  const auto number = [](const char* name, double value) {
    return "float " + std::string(name) + " = " + shortest(value);
  };
  return "shader gonio_material(" + colour("Diffuse", surface.diffuse) + ",\n" + "                      " +
         colour("Highlight", surface.specular) + ",\n" + "                      " + number("Alpha", surface.alpha) +
         ", " + number("F0", surface.f0) + ",\n" +
         "                      output closure color BSDF = 0)\n{\n"
         "    BSDF = Diffuse * diffuse(N) + Highlight * generalized_schlick_bsdf(N, vector(0.0), color(1.0), "
         "color(0.0),\n"
         "                                                                       Alpha, Alpha, color(F0), color(1.0),\n"
         "                                                                       5.0, \"ggx\");\n}\n";
}

}  // namespace gonio::io
