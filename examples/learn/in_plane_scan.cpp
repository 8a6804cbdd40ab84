/// An in-plane scan as goniometers make it: the light is fixed, and the viewer moves from grazing on the light's side
/// through the normal to grazing on the other side. The instrument gives the BRDF times the cosine of the light's
/// angle. Prints the reconstruction and its intervals in the plane and across it.

#include <gonio/estimate/reconstruction.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/model/formula_materials.hpp>

#include <cmath>
#include <cstdio>

/// Returns the viewer's direction in the plane of light and normal. A positive angle is on the side of the mirror
/// direction, a negative one on the light's side, where -theta_i is retro-reflection.
gonio::direction viewer(double signed_angle) {
  const double azimuth = signed_angle >= 0.0 ? gonio::radians(180.0) : 0.0;  // the light's azimuth is 0
  return gonio::spherical_direction(std::abs(signed_angle), azimuth);
}

int main() {
  const auto prior = gonio::io::read_prior("materials.prior");
  const auto truth = gonio::model::formula_material("red-paint");  // the sample in the instrument
  const double theta_i = gonio::radians(45.0);
  const gonio::direction light = gonio::spherical_direction(theta_i, 0.0);

  gonio::sample_set samples;
  for (int degrees = -80; degrees <= 80; degrees += 4) {
    const gonio::direction view = viewer(gonio::radians(degrees));
    const gonio::rgb instrument = truth(light, view) * std::cos(theta_i);
    samples.push_back({gonio::to_half_difference(light, view), instrument / std::cos(theta_i)});
  }
  const auto paint = gonio::reconstruction{prior, {.noise = 0.02}}.fit(samples);

  const auto show = [&](const gonio::direction& view) {
    const auto [low, high] = paint.interval(light, view, gonio::confidence_level::ninety_five_percent);
    std::printf("%8.4f %13.4f %9.4f to %.4f\n", truth(light, view).x(), paint(light, view).x(), low.x(), high.x());
  };
  std::printf("viewer          truth, red  fit, sr^-1   with 95 %%\n");
  for (const double degrees : {-62.0, -46.0, -2.0, 26.0, 38.0, 46.0, 58.0}) {
    std::printf("%4.0f degrees    ", degrees);
    show(viewer(gonio::radians(degrees)));
  }
  std::printf("out of the plane");
  show(gonio::spherical_direction(theta_i, gonio::radians(90.0)));
}
