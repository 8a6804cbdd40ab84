/// Zemax's tables as complete materials: written, read, and evaluated.

#include "scratch.hpp"
#include <gonio/io/measurements/zemax_bsdf.hpp>
#include <gonio/io/measurements/zemax_table.hpp>
#include <gonio/model/ggx.hpp>
#include <gonio/model/lambert.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

using gonio::direction;
using gonio::rgb;
using gonio::io::read_zemax_table;
using gonio::io::tabulate_about_specular;
using gonio::io::zemax_resolution;
using scratch::check_refused;

namespace {

constexpr double pi = std::numbers::pi;
constexpr zemax_resolution small{.rotations = 12, .incidences = 9, .azimuths = 12, .radials = 20};

const gonio::model::anisotropic_ggx& brushed() {
  static const gonio::model::anisotropic_ggx f(rgb(0.9, 0.6, 0.3), {.alpha_x = 0.2, .alpha_y = 0.5, .f0 = 0.8});
  return f;
}

}  // namespace

TEST_CASE("Zemax: a written table has the keywords of the format, and its angles") {
  const std::string text = gonio::io::write_zemax_table(tabulate_about_specular(brushed(), small), "brushed\nmetal");
  CHECK(
      text.starts_with("# brushed\\x0ametal\nSource Measured\nSymmetry ASymmetrical4D\nSpectralContent XYZ\n"
                       "ScatterType BRDF\nSampleRotation 12\n0 30 60 90 120 150 180 210 240 270 300 330\n"
                       "AngleOfIncidence 9\n0 10.625 "));
  for (const char* words :
       {"\nScatterAzimuth 12\n0 30 ", "\nScatterRadial 20\n0 0.485 ", "\n\nTristimulusX\nDataBegin\nTIS ",
        "DataEnd\n\nTristimulusY\n", "DataEnd\n\nTristimulusZ\n"})
    CHECK(text.find(words) != std::string::npos);
  CHECK(text.ends_with("DataEnd\n"));
}

TEST_CASE("Zemax: a material with rotations is read back and evaluated like the original") {
  const zemax_resolution fine{.rotations = 36, .incidences = 18, .azimuths = 36, .radials = 48};
  const auto grid = tabulate_about_specular(brushed(), fine);
  const scratch::folder here;
  gonio::io::write_zemax_table(here / "brushed.bsdf", grid);
  const auto material = read_zemax_table(here / "brushed.bsdf");
  CHECK(material.is_anisotropic());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> cosine(0.3, 1.0), turn(0.0, 2.0 * pi);
  std::vector<double> errors;
  for (int i = 0; i < 2000; ++i) {
    const direction wi = gonio::spherical_direction(std::acos(cosine(random)), turn(random)),
                    wo = gonio::spherical_direction(std::acos(cosine(random)), turn(random));
    errors.push_back((material(wi, wo) / brushed()(wi, wo) - 1.0).abs().maxCoeff());
  }
  std::ranges::sort(errors);
  MESSAGE("median ", errors[1000], ", 99 % ", errors[1980]);
  CHECK(errors[1000] < 0.03);
  CHECK(errors[1980] < 0.3);
  // At a node the value is exact to the file's six digits.
  const auto [wi, wo] = gonio::model::directions_of(grid, 7777);
  REQUIRE(wo.z() > 0.0);
  CHECK((material.as_measured(wi, wo) / brushed()(wi, wo) - 1.0).abs().maxCoeff() < 2e-5);
}

TEST_CASE("Zemax: the samples of a written table have its azimuths, once each") {
  const std::string text = gonio::io::write_zemax_table(tabulate_about_specular(brushed(), small));
  const auto samples = gonio::io::read_zemax_bsdf(text, "x");
  for (std::size_t i = 0; i < samples.size(); i += 97) {
    const auto& [wi, wo] = samples[i].directions.pair();
    CHECK((samples[i].value / brushed()(wi, wo) - 1.0).abs().maxCoeff() < 1e-4);
  }
  std::string again = text;
  again.replace(again.find("300 330\n"), 8, "300 360\n");  // the last rotation is the first
  CHECK(gonio::io::read_zemax_bsdf(again, "x").size() < samples.size());
  CHECK(read_zemax_table(again, "x").grid().phi_i.size() == 11);
}

TEST_CASE("Zemax: an isotropic material has one rotation and half of the azimuths") {
  const gonio::model::ggx f{.alpha = 0.3, .f0 = rgb(0.9, 0.5, 0.1)};
  const auto grid = tabulate_about_specular(f, {.rotations = 1});
  const std::string text = gonio::io::write_zemax_table(grid);
  CHECK(text.find("Symmetry PlaneSymmetrical\n") != std::string::npos);
  CHECK(text.find("\nSampleRotation 1\n0\n") != std::string::npos);
  CHECK(text.find("\nScatterAzimuth 13\n0 15 ") != std::string::npos);
  const auto material = read_zemax_table(text, "x");
  CHECK(!material.is_anisotropic());
  for (const double azimuth : {0.0, 1.0, 2.5, 4.0}) {
    const direction wi = gonio::spherical_direction(0.6, azimuth), wo = gonio::spherical_direction(0.8, azimuth + 2.6),
                    mirrored = gonio::spherical_direction(0.8, azimuth - 2.6);
    CHECK((material(wi, wo) / f(wi, wo) - 1.0).abs().maxCoeff() < 0.03);
    CHECK((material(wi, wo) - material(wi, mirrored)).abs().maxCoeff() < 1e-9);
  }
}

TEST_CASE("Zemax: the total integrated scatter is the albedo") {
  const auto grid = tabulate_about_specular(gonio::model::lambertian{.albedo = rgb::Constant(0.5)}, {.rotations = 1});
  const std::string text = gonio::io::write_zemax_table(grid);
  const std::size_t at = text.find("TIS ", text.find("TristimulusY"));
  CHECK(std::stod(text.substr(at + 4)) == doctest::Approx(0.5).epsilon(0.02));
}

TEST_CASE("Zemax: a value near the horizon is not darkened by the nodes below it") {
  const auto grid = tabulate_about_specular(gonio::model::lambertian{.albedo = rgb::Constant(0.5)}, small);
  const auto material = read_zemax_table(gonio::io::write_zemax_table(grid), "x");
  for (const double theta : {1.2, 1.4, 1.55})
    for (const double azimuth : {0.1, 2.0, 4.4})
      CHECK(material(gonio::spherical_direction(0.7, 0.3), gonio::spherical_direction(theta, azimuth)).y() ==
            doctest::Approx(0.5 / pi).epsilon(1e-4));
}

TEST_CASE("Zemax: impossible tables are refused") {
  const std::string text = gonio::io::write_zemax_table(tabulate_about_specular(brushed(), small));
  std::string descending = text;
  descending.replace(descending.find("300 330\n"), 8, "330 300\n");
  check_refused([&] { return read_zemax_table(descending, "x.bsdf"); }, {"x.bsdf: ", "ascending", "azimuth"});
  check_refused([&] { return read_zemax_table(text.substr(0, text.size() - 40), "x.bsdf"); },
                {"x.bsdf", "ends before"});
  check_refused([&] { return gonio::io::zemax_grid({.rotations = 0}); }, {"from 1 to 360 rotations", "not 0"});
  check_refused([&] { return gonio::io::zemax_grid({.radials = 1}); }, {"and 1"});
  check_refused([&] { return gonio::io::write_zemax_table(gonio::model::angle_grid{}); }, {"about the specular"});
  scratch::check_refuses_non_files([](const auto& path) { return read_zemax_table(path); });
  scratch::check_survives_damage(
      scratch::bytes_of(gonio::io::write_zemax_table(
          tabulate_about_specular(brushed(), {.rotations = 2, .incidences = 2, .azimuths = 3, .radials = 3}))),
      1000, [](std::span<const std::byte> bytes) { return read_zemax_table(gonio::io::as_text(bytes), "file"); });
}
