/// Evaluates a BRDF: its values, its albedo, and its reciprocity.

#include <gonio/model/formula_materials.hpp>
#include <gonio/model/lambert.hpp>

#include <cmath>
#include <cstdio>
#include <numbers>

/// Returns the directional albedo for light from wi: the integral of f cos(theta_o) over the hemisphere, by the
/// midpoint rule in theta_o and phi_o. The library's model::directional_albedo also resolves narrow highlights.
template <gonio::brdf Brdf>
double albedo(const Brdf& f, const gonio::direction& wi) {
  constexpr int steps = 400;
  constexpr double pi = std::numbers::pi, step = 0.5 * pi / steps;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i)
    for (int k = 0; k < 4 * steps; ++k) {
      const double theta_o = (i + 0.5) * step, phi_o = (k + 0.5) * step;
      const double solid_angle = std::sin(theta_o) * step * step;
      sum += f(wi, gonio::spherical_direction(theta_o, phi_o)).x() * std::cos(theta_o) * solid_angle;
    }
  return sum;
}

int main() {
  const gonio::model::lambertian chalk{.albedo = gonio::rgb::Constant(0.8)};
  const auto paint = gonio::model::formula_material("red-paint");
  const auto at = [](double theta, double phi) {
    return gonio::spherical_direction(gonio::radians(theta), gonio::radians(phi));
  };

  std::printf("light at 45 degrees, red channel, sr^-1\n%8s %8s %8s\n", "viewer", "chalk", "paint");
  for (const double viewer : {-60.0, -30.0, 0.0, 30.0, 45.0, 60.0}) {
    const gonio::direction wi = at(45.0, 180.0), wo = at(viewer, 0.0);
    std::printf("%8.0f %8.3f %8.3f\n", viewer, chalk(wi, wo).x(), paint(wi, wo).x());
  }
  std::printf("albedo\n%8s %8s %8s\n", "light", "chalk", "paint");
  for (const double light : {0.0, 45.0, 80.0})
    std::printf("%8.0f %8.3f %8.3f\n", light, albedo(chalk, at(light, 180.0)), albedo(paint, at(light, 180.0)));
  const gonio::direction lamp = at(70.0, 180.0), eye = at(20.0, 40.0);
  std::printf("lamp and eye exchanged: %.5f and %.5f\n", paint(lamp, eye).x(), paint(eye, lamp).x());
}
