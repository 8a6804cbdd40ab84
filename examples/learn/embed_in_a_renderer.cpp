/// Embeds a BRDF in a renderer: evaluates it, and importance-samples directions towards the light.

#include <gonio/io/materials/merl.hpp>
#include <gonio/render.hpp>

#include <cstdio>
#include <random>

int main() {
  const gonio::render::half_vector_sampler paint(
      gonio::render::lookup_table<Eigen::half>::of(gonio::io::read_merl("paint.binary")));

  const gonio::direction wo(0.6, 0.0, 0.8);                     // towards the viewer
  const auto [wi, weight, pdf] = paint.sample(wo, 0.25, 0.75);  // towards the light, from two random numbers
  const gonio::rgb f = paint.brdf()(wi, wo);                    // weight * pdf is f * wi.z()
  std::printf("f(wi, wo) red %.4f sr^-1, pdf %.4f sr^-1\n", f.x(), pdf);
  if (pdf != paint.pdf(wi, wo) || (weight * pdf - f * wi.z()).abs().maxCoeff() > 1e-9) return 1;

  // The albedo: the mean of the weights.
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> number;
  gonio::rgb sum = gonio::rgb::Zero();
  constexpr int draws = 100'000;
  for (int i = 0; i < draws; ++i) {
    const double u1 = number(generator), u2 = number(generator);
    sum += paint.sample(wo, u1, u2).weight;
  }
  std::printf("albedo %.3f %.3f %.3f\n", sum.x() / draws, sum.y() / draws, sum.z() / draws);
}
