#include <gonio/estimate/decomposition.hpp>
#include <gonio/io/merl.hpp>
#include <gonio/io/prior.hpp>
#include <gonio/io/samples.hpp>
#include <gonio/solve/tikhonov.hpp>

int main() {
  const auto prior = gonio::io::read_prior("materials.prior");
  const auto samples = gonio::io::read_samples("measurements.csv");
  const auto paint = gonio::decomposition{prior, gonio::tikhonov{40.0}}.fit(samples);
  gonio::io::write_merl("paint.binary", paint);
}
