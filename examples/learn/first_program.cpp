#include <gonio/estimate/reconstruction.hpp>
#include <gonio/io/materials/merl.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/measurements/samples.hpp>

int main() {
  const auto prior = gonio::io::read_prior("materials.prior");
  const auto samples = gonio::io::read_samples("measurements.csv");
  const auto paint = gonio::reconstruction{prior}.fit(samples);
  gonio::io::write_merl("paint.binary", paint);
}
