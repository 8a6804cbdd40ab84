#include "../base64.hpp"
#include "../json.hpp"
#include "scratch.hpp"
#include <gonio/core/fresnel.hpp>
#include <gonio/io/materials/renderer_material.hpp>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

namespace {

using gonio::rgb;
using gonio::model::analytic_brdf;
using gonio::model::lobe_kind;

analytic_brdf paint(const char* rough) {
  return analytic_brdf({{lobe_kind::of<gonio::model::lambert_shape>(), {0.5, 0.25, 0.125}, {}},
                        {gonio::model::lobe_kind_named(rough), {1.0, 0.75, 0.5}, {0.25, 0.25}}});
}

analytic_brdf metal() {
  return analytic_brdf({{lobe_kind::of<gonio::model::ggx_shape>(), {1.0, 0.5, 0.25}, {0.25, 0.5}}});
}

}  // namespace

TEST_CASE("pbrt: a rough lobe over a diffuse one") {
  CHECK(gonio::io::pbrt_material(paint("ggx")) ==
        "Material \"coateddiffuse\"\n"
        "  \"rgb reflectance\" [ " +
            gonio::io::detail::three_numbers(gonio::io::detail::base_below_coat({0.5, 0.25, 0.125}, 3.0), " ") +
            " ]\n"
            "  \"float roughness\" [ 0.25 ]\n"
            "  \"bool remaproughness\" false\n"
            "  \"float eta\" [ 3 ]\n"
            "  \"float thickness\" [ 0 ]\n"
            "  \"integer maxdepth\" [ 100 ]\n");
  CHECK(gonio::io::pbrt_material(metal()) ==
        "Material \"conductor\"\n"
        "  \"rgb reflectance\" [ 0.5 0.25 0.125 ]\n"
        "  \"float roughness\" [ 0.25 ]\n"
        "  \"bool remaproughness\" false\n");
}

TEST_CASE("a base below a coat without absorption is seen with the given albedo") {
  using gonio::io::detail::base_below_coat;
  const rgb seen(0.5, 0.25, 0.125);
  CHECK((base_below_coat(seen, 1.0) - seen).abs().maxCoeff() < 1e-12);
  // A dielectric of index 1.5 reflects 9.2 % of diffuse light outside and 59.6 % inside (Saunderson 1942: 60 %).
  const rgb base = base_below_coat(seen, 1.5), back = 0.908 * 0.404 * base / (1.0 - 0.596 * base);
  CHECK((back - seen).abs().maxCoeff() < 1e-3);
  CHECK((base_below_coat(rgb(1.0, 0.99, 0.0), 2.0) == rgb(1.0, 1.0, 0.0)).all());
}

TEST_CASE("Mitsuba: the sum of both lobes") {
  analytic_brdf bright({{lobe_kind::of<gonio::model::lambert_shape>(), {0.5, 0.25, 0.125}, {}},
                        {lobe_kind::of<gonio::model::torrance_sparrow_shape>(), {2.0, 1.0, 0.5}, {0.25, 0.04}}});
  const auto interface = gonio::io::detail::conductor_like_schlick(0.04);
  CHECK(gonio::io::mitsuba_material(bright) ==
        "<bsdf type=\"blendbsdf\">\n"
        "  <float name=\"weight\" value=\"0.5\"/>\n"
        "  <bsdf type=\"diffuse\">\n"
        "    <spectrum type=\"srgb\" name=\"reflectance\">\n"
        "      <rgb name=\"color\" value=\"1, 0.5, 0.25\"/>\n"
        "      <boolean name=\"unbounded\" value=\"true\"/>\n"
        "    </spectrum>\n"
        "  </bsdf>\n"
        "  <bsdf type=\"roughconductor\">\n"
        "    <string name=\"distribution\" value=\"beckmann\"/>\n"
        "    <float name=\"alpha\" value=\"0.25\"/>\n"
        "    <spectrum name=\"eta\" value=\"" +
            gonio::io::shortest(interface.index) +
            "\"/>\n"
            "    <spectrum name=\"k\" value=\"" +
            gonio::io::shortest(interface.extinction) +
            "\"/>\n"
            "    <spectrum type=\"srgb\" name=\"specular_reflectance\">\n"
            "      <rgb name=\"color\" value=\"4, 2, 1\"/>\n"
            "      <boolean name=\"unbounded\" value=\"true\"/>\n"
            "    </spectrum>\n"
            "  </bsdf>\n"
            "</bsdf>\n");
}

TEST_CASE("a conductor reflects f0 at normal incidence and nearly follows Schlick elsewhere") {
  for (const double f0 : {0.02, 0.04, 0.1, 0.3, 0.6, 0.9}) {
    const auto found = gonio::io::detail::conductor_like_schlick(f0);
    CHECK(gonio::fresnel_conductor(1.0, found.index, found.extinction) == doctest::Approx(f0).epsilon(1e-6));
    const double most = f0 >= 0.6 ? 0.006 : f0 >= 0.3 ? 0.06 : 0.32;
    for (double degrees = 5.0; degrees <= 85.0; degrees += 10.0) {
      const double cosine = std::cos(gonio::radians(degrees));
      CHECK(std::abs(gonio::fresnel_conductor(cosine, found.index, found.extinction) /
                         gonio::fresnel_schlick(cosine, f0) -
                     1.0) < most);
    }
  }
  // A fitted f0 may be outside 0 to 1.
  for (const double f0 : {-0.1, 0.0, 1.0, 3.0}) {
    const auto found = gonio::io::detail::conductor_like_schlick(f0);
    CHECK(std::isfinite(found.index + found.extinction));
  }
}

TEST_CASE("highlight colours above 1 become a higher reflectance at normal incidence") {
  const analytic_brdf brown({{lobe_kind::of<gonio::model::lambert_shape>(), {0.5, 0.25, 0.125}, {}},
                             {lobe_kind::of<gonio::model::ggx_shape>(), {5.0, 2.5, 1.25}, {0.25, 0.05}}});
  const std::string text = gonio::io::materialx_material(brown);
  CHECK(text.find("\"specular_color\" type=\"color3\" value=\"1, 0.5, 0.25\"") != std::string::npos);
  CHECK(text.find("\"specular_ior\" type=\"float\" value=\"3\"") != std::string::npos);
  CHECK(gonio::io::pbrt_material(brown).find("\"float eta\" [ 3 ]") != std::string::npos);
}

TEST_CASE("a base that is negligible beside the highlight gives a metal") {
  const analytic_brdf gold({{lobe_kind::of<gonio::model::lambert_shape>(), {0.003, 0.001, 0.0}, {}},
                            {lobe_kind::of<gonio::model::ggx_shape>(), {1.0, 0.75, 0.5}, {0.25, 0.75}}});
  CHECK(read_json(gonio::io::gltf_material(gold))["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] == 1);
  CHECK(gonio::io::materialx_material(gold).find("\"base_metalness\" type=\"float\" value=\"1\"") != std::string::npos);
}

TEST_CASE("a highlight brighter than any dielectric's gives a metal mixed with the base") {
  const analytic_brdf orange({{lobe_kind::of<gonio::model::lambert_shape>(), {0.25, 0.375, 0.375}, {}},
                              {lobe_kind::of<gonio::model::ggx_shape>(), {1.0, 0.75, 0.25}, {0.25, 0.5}}});
  // The highlight reflects 0.5, 0.375 and 0.125: as much as the base.
  CHECK(gonio::io::pbrt_material(orange) ==
        "MakeNamedMaterial \"base\"\n"
        "  \"string type\" \"diffuse\"\n"
        "  \"rgb reflectance\" [ 0.5 0.75 0.75 ]\n"
        "MakeNamedMaterial \"metal\"\n"
        "  \"string type\" \"conductor\"\n"
        "  \"rgb reflectance\" [ 1 0.75 0.25 ]\n"
        "  \"float roughness\" [ 0.25 ]\n"
        "  \"bool remaproughness\" false\n"
        "Material \"mix\"\n"
        "  \"string materials\" [ \"base\" \"metal\" ]\n"
        "  \"float amount\" [ 0.5 ]\n");
  const std::string surface = gonio::io::materialx_material(orange);
  for (const char* line :
       {"\"base_metalness\" type=\"float\" value=\"0.5\"", "\"specular_ior\" type=\"float\" value=\"1\""})
    CHECK_MESSAGE(surface.find(line) != std::string::npos, line);
  CHECK(surface.find("specular_color") == std::string::npos);
  const auto document = read_json(gonio::io::gltf_material(orange));
  const auto& material = document["materials"][0];
  CHECK(material["pbrMetallicRoughness"]["metallicFactor"] == 0.5);
  CHECK(material["pbrMetallicRoughness"]["baseColorFactor"][0] == doctest::Approx(0.75));
  CHECK(material["extensions"]["KHR_materials_ior"]["ior"] == 1);
}

TEST_CASE("OpenPBR in MaterialX: a rough lobe over a diffuse one") {
  CHECK(gonio::io::materialx_material(paint("ggx"), "red_paint") ==
        "<?xml version=\"1.0\"?>\n"
        "<materialx version=\"1.39\" colorspace=\"lin_rec709\">\n"
        "  <open_pbr_surface name=\"red_paint_surface\" type=\"surfaceshader\">\n"
        "    <input name=\"base_weight\" type=\"float\" value=\"1\"/>\n"
        "    <input name=\"base_color\" type=\"color3\" value=\"0.5, 0.25, 0.125\"/>\n"
        "    <input name=\"base_metalness\" type=\"float\" value=\"0\"/>\n"
        "    <input name=\"specular_roughness\" type=\"float\" value=\"0.5\"/>\n"
        "    <input name=\"specular_color\" type=\"color3\" value=\"1, 0.75, 0.5\"/>\n"
        "    <input name=\"specular_ior\" type=\"float\" value=\"3\"/>\n"
        "  </open_pbr_surface>\n"
        "  <surfacematerial name=\"red_paint\" type=\"material\">\n"
        "    <input name=\"surfaceshader\" type=\"surfaceshader\" nodename=\"red_paint_surface\"/>\n"
        "  </surfacematerial>\n"
        "</materialx>\n");
  const std::string of_metal = gonio::io::materialx_material(metal());
  CHECK(of_metal.find("\"base_metalness\" type=\"float\" value=\"1\"") != std::string::npos);
  CHECK(of_metal.find("\"base_color\" type=\"color3\" value=\"0.5, 0.25, 0.125\"") != std::string::npos);
  CHECK(of_metal.find("specular_ior") == std::string::npos);
  for (const char* wrong : {"", "red paint", "a\"b"})
    CHECK_THROWS_WITH_AS(gonio::io::materialx_material(metal(), wrong), doctest::Contains("letters, digits"),
                         gonio::error);
}

TEST_CASE("glTF: the material is on a sphere whose triangles face outwards") {
  const auto document = read_json(gonio::io::gltf_material(metal()));
  const std::string uri = document["buffers"][0]["uri"].get<std::string>(),
                    start = "data:application/octet-stream;base64,";
  REQUIRE(uri.starts_with(start));
  const std::vector<std::byte> bytes = from_base64(uri.substr(start.size()));
  REQUIRE(bytes.size() == document["buffers"][0]["byteLength"].get<std::size_t>());
  const auto& views = document["bufferViews"];
  const auto offset = views[1]["byteOffset"].get<std::size_t>();
  CHECK(offset == views[0]["byteLength"].get<std::size_t>());
  CHECK(bytes.size() == offset + views[1]["byteLength"].get<std::size_t>());
  Eigen::Matrix3Xf points(3, document["accessors"][0]["count"].get<Eigen::Index>());
  std::vector<std::uint16_t> corners(document["accessors"][1]["count"].get<std::size_t>());
  REQUIRE(offset == 4 * static_cast<std::size_t>(points.size()));
  REQUIRE(bytes.size() == offset + 2 * corners.size());
  std::memcpy(points.data(), bytes.data(), offset);
  std::memcpy(corners.data(), bytes.data() + offset, 2 * corners.size());
  double volume = 0.0;  // of the tetrahedra with the centre
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    REQUIRE(std::max({corners[i], corners[i + 1], corners[i + 2]}) < points.cols());
    const Eigen::Vector3f a = points.col(corners[i]), b = points.col(corners[i + 1]), c = points.col(corners[i + 2]);
    CHECK((b - a).cross(c - a).dot(a + b + c) > 0.0f);
    volume += double{a.dot(b.cross(c))} / 6.0;
  }
  CHECK(volume == doctest::Approx(4.0 / 3.0 * std::numbers::pi).epsilon(0.03));
  CHECK((points.colwise().norm().array() - 1.0f).abs().maxCoeff() < 1e-6f);
}

TEST_CASE("Open Shading Language: a rough lobe over a diffuse one") {
  CHECK(
      gonio::io::osl_shader(paint("ggx")) ==
      "shader gonio_material(color Diffuse = color(0.5, 0.25, 0.125),\n"
      "                      color Highlight = color(1, 0.75, 0.5),\n"
      "                      float Alpha = 0.25, float F0 = 0.25,\n"
      "                      output closure color BSDF = 0)\n{\n"
      "    BSDF = Diffuse * diffuse(N) + Highlight * generalized_schlick_bsdf(N, vector(0.0), color(1.0), color(0.0),\n"
      "                                                                       Alpha, Alpha, color(F0), color(1.0),\n"
      "                                                                       5.0, \"ggx\");\n}\n");
  CHECK_THROWS_WITH_AS(gonio::io::osl_shader(paint("torrance-sparrow")), doctest::Contains("Cycles"), gonio::error);
}

TEST_CASE("glTF: a metal, and a highlight colour above 1") {
  const std::string text = gonio::io::gltf_material(metal());
  CHECK(text.starts_with("{\n  \"asset\": {\"version\": \"2.0\", \"generator\": \"gonio\"},\n  \"scene\": 0,\n"));
  CHECK(text.substr(text.find("  \"materials\"")) ==
        "  \"materials\": [\n"
        "    {\n"
        "      \"pbrMetallicRoughness\": {\n"
        "        \"baseColorFactor\": [0.5, 0.25, 0.125, 1],\n"
        "        \"metallicFactor\": 1,\n"
        "        \"roughnessFactor\": 0.5\n"
        "      }\n"
        "    }\n"
        "  ]\n"
        "}\n");
  // A highlight colour above 1: the factor is 1, the colour has the rest.
  analytic_brdf bright({{lobe_kind::of<gonio::model::lambert_shape>(), {0.5, 0.25, 0.125}, {}},
                        {lobe_kind::of<gonio::model::ggx_shape>(), {2.0, 1.0, 0.5}, {0.25, 1.0 / 9.0}}});
  const auto document = read_json(gonio::io::gltf_material(bright));
  const auto& material = document["materials"][0];
  CHECK(document["extensionsUsed"].size() == 2);
  CHECK(material["pbrMetallicRoughness"]["metallicFactor"] == 0);
  CHECK(material["extensions"]["KHR_materials_ior"]["ior"] == doctest::Approx(2.0));
  CHECK(material["extensions"]["KHR_materials_specular"]["specularFactor"] == 1);
  CHECK(material["extensions"]["KHR_materials_specular"]["specularColorFactor"][0] == 2.0);
  CHECK(material["extensions"]["KHR_materials_specular"]["specularColorFactor"][2] == 0.5);
}

TEST_CASE("models that renderers lack are refused") {
  for (const auto material :
       {gonio::io::gltf_material, +[](const analytic_brdf& model) { return gonio::io::materialx_material(model); }})
    CHECK_THROWS_WITH_AS(material(paint("torrance-sparrow")), doctest::Contains("fit ggx instead"), gonio::error);
  CHECK_THROWS_WITH_AS(gonio::io::pbrt_material(paint("torrance-sparrow")), doctest::Contains("fit ggx instead"),
                       gonio::error);
  const analytic_brdf two({metal().lobes()[0], metal().lobes()[0]}), none;
  CHECK_THROWS_WITH_AS(gonio::io::mitsuba_material(two), doctest::Contains("one rough lobe, not 2"), gonio::error);
  CHECK_THROWS_WITH_AS(gonio::io::mitsuba_material(none), doctest::Contains("one rough lobe, not 0"), gonio::error);
  const analytic_brdf phong({{lobe_kind::of<gonio::model::phong_shape>(), rgb::Ones(), {30.0}}});
  CHECK_THROWS_WITH_AS(gonio::io::mitsuba_material(phong), doctest::Contains("not phong"), gonio::error);
}

TEST_CASE("a material's text is written unchanged") {
  const scratch::folder folder;
  gonio::io::write_renderer_material(folder / "paint.xml", gonio::io::mitsuba_material(paint("ggx")));
  std::ostringstream text;
  text << std::ifstream(folder / "paint.xml").rdbuf();
  CHECK(text.str() == gonio::io::mitsuba_material(paint("ggx")));
}
