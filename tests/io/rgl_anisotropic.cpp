/// Anisotropic files of the RGL database: written, read, and read again.

#include "scratch.hpp"
#include <gonio/io/materials/rgl.hpp>
#include <gonio/io/materials/rgl_spectra.hpp>
#include <gonio/model/ggx.hpp>

#include <cmath>
#include <numbers>

using gonio::io::read_rgl;
using gonio::io::rgl_material;
using scratch::check_refused;

namespace {

const rgl_material& brushed() {
  static const rgl_material made{
      gonio::model::tabulate_adaptively(
          gonio::model::anisotropic_ggx(gonio::rgb(0.9, 0.6, 0.3), {.alpha_x = 0.15, .alpha_y = 0.4, .f0 = 0.8}),
          gonio::model::anisotropic_resolution{
              .phi_i = 13, .theta_i = 8, .values = 16, .visible_normals = 24, .normals = 32}),
      "brushed",
      {}};
  return made;
}

}  // namespace

TEST_CASE("an anisotropic file has its azimuths first, as the database's loader and Mitsuba need") {
  const std::vector<std::byte> bytes = gonio::io::write_rgl(brushed());
  const auto found = gonio::io::detail::tensor_fields(bytes, "written");
  const std::map<std::string, std::vector<std::uint64_t>> expected{{"phi_i", {13}},
                                                                   {"theta_i", {8}},
                                                                   {"ndf", {32, 32}},
                                                                   {"sigma", {17, 17}},
                                                                   {"vndf", {13, 8, 24, 24}},
                                                                   {"luminance", {13, 8, 16, 16}},
                                                                   {"rgb", {13, 8, 3, 16, 16}}};
  for (const auto& [name, shape] : expected) {
    CAPTURE(name);
    REQUIRE(found.contains(name));
    CHECK(found.at(name).shape == shape);
  }
}

TEST_CASE("an anisotropic material is read back number for number") {
  const scratch::folder here;
  gonio::io::write_rgl(here / "brushed.bsdf", brushed());
  const rgl_material again = read_rgl(here / "brushed.bsdf");
  CHECK(again.description == "brushed");
  CHECK(again.material.is_anisotropic());
  CHECK(again.material.parts().phi_i.size() == 13);
  CHECK(again.material.parts().reflectance.values == brushed().material.parts().reflectance.values);
  CHECK(again.material.parts().visible_normals.values == brushed().material.parts().visible_normals.values);
  CHECK(gonio::io::write_rgl(again) == gonio::io::write_rgl(brushed()));
  const auto wi = gonio::spherical_direction(0.6, 0.4), wo = gonio::spherical_direction(0.5, 3.3);
  CHECK((again.material(wi, wo) / brushed().material(wi, wo) - 1.0).abs().maxCoeff() < 1e-6);
  // Golden: the value of the database's loader (github.com/rgl-epfl/brdf-loader) for this file, divided by the cosine.
  const gonio::rgb golden(1.13959309, 0.759728862, 0.379864431);
  CHECK((again.material.as_measured(wi, wo) / golden - 1.0).abs().maxCoeff() < 1e-5);
}

TEST_CASE("an anisotropic material in spectra is read back and evaluated at its azimuths") {
  rgl_material spectral = brushed();
  spectral.spectra = gonio::io::upsampled_spectra(spectral.material);
  const rgl_material again = read_rgl(gonio::io::write_rgl(spectral), "again");
  REQUIRE(again.spectra);
  CHECK(again.spectra->values.tables == 13 * 8 * std::ssize(again.spectra->wavelengths));
  const auto wi = gonio::spherical_direction(0.6, 0.4), wo = gonio::spherical_direction(0.5, 3.3);
  CHECK((again.material(wi, wo) / spectral.material(wi, wo) - 1.0).abs().maxCoeff() < 1e-4);
  const auto turned = [](const gonio::direction& w) { return gonio::turned_about_normal(w, 1.5); };
  const std::vector<gonio::sample_directions> directions{gonio::direction_pair{wi, wo},
                                                         gonio::direction_pair{turned(wi), turned(wo)}};
  const gonio::rgb seen = gonio::io::sample_spectra(again, directions).under(gonio::illuminant::d65).colours()[1].value;
  CHECK((seen / spectral.material(turned(wi), turned(wo)) - 1.0).abs().maxCoeff() < 0.01);
  check_refused(
      [&] {
        return gonio::io::tabulate_spectra(again, gonio::valid_cells(gonio::grid({9, 9, 9})));
      },
      {"is anisotropic", "isotropic one"});
}

TEST_CASE("damaged anisotropic files are read or refused") {
  const rgl_material small{
      gonio::model::tabulate_adaptively(gonio::model::anisotropic_ggx(gonio::rgb::Ones()),
                                        gonio::model::anisotropic_resolution{
                                            .phi_i = 4, .theta_i = 2, .values = 2, .visible_normals = 3, .normals = 4}),
      "small",
      {}};
  scratch::check_survives_damage(gonio::io::write_rgl(small), 3000,
                                 [](std::span<const std::byte> bytes) { return read_rgl(bytes, "file"); });
}
