#include "physical.hpp"
#include <gonio/core/error.hpp>
#include <gonio/model/ggx.hpp>
#include <gonio/model/instrument_readings.hpp>
#include <gonio/model/lambert.hpp>
#include <gonio/table/brdf_table.hpp>

#include <cmath>
#include <numbers>
#include <random>

using gonio::direction;
using gonio::radians;
using gonio::rgb;
namespace model = gonio::model;

namespace {

const model::lambertian white{.albedo = {1.0, 1.0, 1.0}};

/// The integral of cos theta over a rectangle of directions around an angle in the plane of incidence.
double projected_solid_angle(double centre, const model::field_angles& field) {
  const double low = centre - 0.5 * field.in_plane, high = centre + 0.5 * field.in_plane, half = 0.5 * field.across;
  return (std::sin(high) - std::sin(low)) * (half + 0.5 * std::sin(2.0 * half));
}

/// Estimates `reflected_share` from random directions of the source and the receptor.
double share_by_chance(const model::ggx& f, const model::reflectometer& meter, int count) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> about_zero(-0.5, 0.5);
  const double area = meter.receptor.in_plane * meter.receptor.across;
  double sum = 0.0;
  for (int i = 0; i < count; ++i) {
    const direction wi = model::detail::tilted(-meter.theta_i - meter.source.in_plane * about_zero(generator),
                                               meter.source.across * about_zero(generator));
    const double across = meter.receptor.across * about_zero(generator);
    const direction wo = model::detail::tilted(
        meter.theta_i + meter.off_mirror + meter.receptor.in_plane * about_zero(generator), across);
    sum += gonio::luminance(f(wi, wo)) * wo.z() * std::cos(across) * area;
  }
  return sum / count;
}

}  // namespace

TEST_CASE("gloss and haze of a perfect diffuser are in closed form") {
  for (const int degrees : model::gloss_angles) {
    const model::reflectometer meter = model::gloss_meter(degrees);
    const double share = projected_solid_angle(meter.theta_i, meter.receptor) / std::numbers::pi;
    CHECK(gonio::luminance(model::reflected_share(white, meter)) == doctest::Approx(share).epsilon(1e-9));
    CHECK(model::specular_gloss(white, degrees) ==
          doctest::Approx(100.0 * share / model::gloss_standard_reflectance(meter.theta_i)).epsilon(1e-9));
  }
  double both = 0.0;
  for (const int side : {-1, 1})
    both += projected_solid_angle(radians(20.0 + 1.9 * side), model::haze_meter(side).receptor) / std::numbers::pi;
  CHECK(model::reflection_haze(white) ==
        doctest::Approx(50.0 * both / model::gloss_standard_reflectance(radians(20.0))).epsilon(1e-9));
}

TEST_CASE("the gloss standard reflects by Fresnel's equations, and a mirror has the gloss of the standard's inverse") {
  CHECK(model::gloss_standard_reflectance(radians(20.0)) == doctest::Approx(0.0490781).epsilon(1e-5));
  CHECK(model::gloss_standard_reflectance(radians(60.0)) == doctest::Approx(0.1000560).epsilon(1e-5));
  CHECK(model::gloss_standard_reflectance(radians(85.0)) == doctest::Approx(0.6191482).epsilon(1e-5));
  // The receptor receives the whole of a narrow lobe.
  const model::ggx mirror{.alpha = 2e-4, .f0 = {1.0, 1.0, 1.0}};
  CHECK(model::specular_gloss(mirror, 20) == doctest::Approx(2037.6).epsilon(0.005));
  CHECK(model::specular_gloss(mirror, 60) == doctest::Approx(999.4).epsilon(0.005));
  CHECK(model::specular_gloss(mirror, 85) == doctest::Approx(161.5).epsilon(0.01));
  CHECK(model::reflection_haze(mirror) < 1.0);
}

TEST_CASE("gloss and haze of lobes of any width are those of random directions") {
  for (const double alpha : {0.02, 0.1, 0.4}) {
    const model::ggx lobe{.alpha = alpha, .f0 = {0.04, 0.05, 0.06}};
    for (const int degrees : model::gloss_angles) {
      const model::reflectometer meter = model::gloss_meter(degrees);
      CAPTURE(alpha);
      CAPTURE(degrees);
      CHECK(gonio::luminance(model::reflected_share(lobe, meter)) ==
            doctest::Approx(share_by_chance(lobe, meter, 400000)).epsilon(0.01));
    }
    for (const int side : {-1, 1})
      CHECK(gonio::luminance(model::reflected_share(lobe, model::haze_meter(side))) ==
            doctest::Approx(share_by_chance(lobe, model::haze_meter(side), 400000)).epsilon(0.01));
  }
}

TEST_CASE("an integrating sphere's readings of a diffuser and of a mirror") {
  const model::instrument_readings diffuse = model::read_instruments(model::lambertian{.albedo = {0.2, 0.5, 0.9}});
  for (int channel = 0; channel < 3; ++channel)
    CHECK(diffuse.total[channel] == doctest::Approx(rgb(0.2, 0.5, 0.9)[channel]).epsilon(0.002));
  // The cone is excluded: its projected solid angle is pi sin^2 of the half angle times the cosine at its axis.
  const double cone = std::pow(std::sin(radians(4.0)), 2) * std::cos(radians(8.0));
  CHECK(diffuse.total.y() - diffuse.diffuse.y() == doctest::Approx(0.5 * cone).epsilon(0.02));
  CHECK(diffuse.scatter ==
        doctest::Approx(1.0 - std::pow(std::sin(radians(2.5)), 2) * std::cos(radians(8.0))).epsilon(0.001));

  const model::instrument_readings mirror = model::read_instruments(model::ggx{.alpha = 1e-3, .f0 = rgb::Ones()});
  CHECK(mirror.total.y() == doctest::Approx(1.0).epsilon(0.005));
  CHECK(mirror.diffuse.y() < 0.01);
  CHECK(mirror.scatter < 0.01);
}

TEST_CASE("multi-angle colours: a diffuser has the same at all angles, and directions are those of the instruments") {
  const model::instrument_readings white_readings = model::read_instruments(white);
  for (const model::aspecular_colour& each : white_readings.colours) {
    CHECK(each.lab.x() == doctest::Approx(100.0));
    CHECK(std::abs(each.lab.y()) < 0.01);
    CHECK(std::abs(each.lab.z()) < 0.02);
  }
  const auto [wi, wo] = model::aspecular_directions(110.0);
  CHECK(gonio::degrees(gonio::polar_angle(wi)) == doctest::Approx(45.0));
  CHECK(gonio::degrees(gonio::polar_angle(wo)) == doctest::Approx(65.0));
  CHECK(wi.x() * wo.x() > 0.0);  // on the light's side
  CHECK(gonio::degrees(gonio::angle_between(model::aspecular_directions(15.0).wo, direction(-wi.x(), 0.0, wi.z()))) ==
        doctest::Approx(15.0));
  // A metal's highlight is brighter than a perfect diffuser.
  CHECK(model::read_instruments(model::ggx{.alpha = 0.1, .f0 = rgb::Ones()}).colours[0].lab.x() > 120.0);
}

TEST_CASE("readings of a table are those of what it was made of") {
  const model::ggx lobe{.alpha = 0.08, .f0 = {0.05, 0.05, 0.05}};
  const model::instrument_readings exact = model::read_instruments(lobe);
  const model::instrument_readings stored = model::read_instruments(gonio::tabulate(lobe, gonio::valid_cells()));
  for (std::size_t i = 0; i < exact.gloss.size(); ++i)
    CHECK(stored.gloss[i] == doctest::Approx(exact.gloss[i]).epsilon(0.02));
  CHECK(stored.haze == doctest::Approx(exact.haze).epsilon(0.02));
}

TEST_CASE("unknown geometries are refused") {
  CHECK_THROWS_AS(model::gloss_meter(45), gonio::error);
  CHECK_THROWS_AS(model::haze_meter(0), gonio::error);
}
