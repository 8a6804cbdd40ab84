/// A table of the renderer's own, looked up and sampled.

#include <gonio/render.hpp>

#include <cmath>

int main() {
  const auto matt = [](const gonio::direction&, const gonio::direction&) noexcept { return gonio::rgb(0.1, 0.2, 0.3); };
  const gonio::render::half_vector_sampler paint(
      gonio::render::lookup_table<float>::tabulated(matt, gonio::grid({18, 18, 36})));
  const gonio::direction wo(0.6, 0.0, 0.8);
  const auto drawn = paint.sample(wo, 0.25, 0.75);
  return std::abs(paint.brdf()(drawn.wi, wo).y() - 0.2) < 1e-6 && drawn.pdf > 0.0 ? 0 : 1;
}
