#pragma once
/// Fitted models as materials of renderers: pbrt-v4 and Mitsuba 3, text.

#include <gonio/io/file.hpp>
#include <gonio/io/text.hpp>
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

  /// The refractive index whose reflectance at normal incidence is f0, which real dielectrics have up to 0.5.
  [[nodiscard]] double refractive_index() const {
    const double root = std::sqrt(std::min(f0, 0.5));
    return (1.0 + root) / (1.0 - root);
  }
  [[nodiscard]] bool metal() const { return (diffuse == 0.0).all(); }
};

/// Throws gonio::error unless the model is one lobe of GGX or Torrance-Sparrow, beside a Lambertian one or not.
[[nodiscard]] inline rough_surface as_rough_surface(const analytic_brdf& model) {
  rough_surface found;
  std::size_t rough = 0;
  for (const analytic_lobe& lobe : model.lobes()) {
    if (lobe.kind() == lobe_kind::of<lambert_shape>()) {
      found.diffuse += lobe.colour();
      continue;
    }
    found.beckmann = lobe.kind() == lobe_kind::of<torrance_sparrow_shape>();
    if (!found.beckmann && !(lobe.kind() == lobe_kind::of<ggx_shape>()))
      throw error("renderers know the lobes ggx and torrance-sparrow beside a diffuse one, not " +
                  std::string(lobe.kind().name()));
    found.specular = lobe.colour();
    found.alpha = lobe.parameters()[0];
    found.f0 = lobe.parameters()[1];
    ++rough;
  }
  if (rough != 1) throw error("a renderer's material has one rough lobe, not " + std::to_string(rough));
  return found;
}

[[nodiscard]] inline std::string three_numbers(const rgb& colour, const std::string& between) {
  return shortest(colour[0]) + between + shortest(colour[1]) + between + shortest(colour[2]);
}

}  // namespace detail

/// A `Material` of pbrt-v4, linear sRGB. GGX beside Lambert becomes `coateddiffuse`: albedo, roughness (not remapped)
/// and refractive index are carried over; the colour of the highlight is not, because the coat has none, nor is there
/// light that it keeps from the base in the sum of lobes. GGX by itself becomes `conductor` with the reflectance at
/// normal incidence, colour times f0. Throws gonio::error for other models: pbrt has no Beckmann distribution.
[[nodiscard]] inline std::string pbrt_material(const analytic_brdf& model) {
  const detail::rough_surface surface = detail::as_rough_surface(model);
  if (surface.beckmann) throw error("pbrt has no Beckmann distribution: fit ggx instead of torrance-sparrow");
  const std::string roughness =
      "  \"float roughness\" [ " + detail::shortest(surface.alpha) + " ]\n  \"bool remaproughness\" false\n";
  if (surface.metal())
    return "Material \"conductor\"\n  \"rgb reflectance\" [ " +
           detail::three_numbers((surface.specular * surface.f0).min(1.0), " ") + " ]\n" + roughness;
  return "Material \"coateddiffuse\"\n  \"rgb reflectance\" [ " + detail::three_numbers(surface.diffuse.min(1.0), " ") +
         " ]\n" + roughness + "  \"float eta\" [ " + detail::shortest(surface.refractive_index()) + " ]\n";
}

/// A `bsdf` of Mitsuba 3, linear sRGB. A rough lobe beside Lambert becomes `roughplastic`, which carries over albedo,
/// roughness, refractive index, distribution and the colour of the highlight; it lets the base have only the light that
/// the interface lets through, which the sum of lobes does not. A rough lobe by itself becomes `roughconductor` of 100
/// % reflectance (material `none`) in the colour times f0: the rise towards grazing angles is not carried over.
[[nodiscard]] inline std::string mitsuba_material(const analytic_brdf& model) {
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

/// Writes such a text; whole, or not at all.
inline void write_renderer_material(const std::filesystem::path& path, const std::string& material) {
  write_atomically(path, std::as_bytes(std::span(material)));
}

}  // namespace gonio::io
