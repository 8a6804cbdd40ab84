#include <gonio/estimate/decomposition.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <cstdio>

// The README's program, with a sample of its own and the installed prior.
int main() {
  const auto prior = gonio::io::read_prior(GONIO_PRIOR);
  const gonio::sample_set samples{{{0.1, 0.5, 1.0}, {0.3, 0.2, 0.1}, 1.0}};
  const auto paint = gonio::decomposition{prior, gonio::tikhonov{40.0}}.fit(samples);
  const gonio::rgb value = paint({0, 0, 1}, {0, 0, 1});
  std::printf("%g %g %g\n", value.x(), value.y(), value.z());
  return value.x() > value.z() && value.z() > 0.0 ? 0 : 1;
}
