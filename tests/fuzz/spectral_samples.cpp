/// Spectral samples: what is accepted is usable but for what `require_usable` names, and what is written is read.

#include "harness.hpp"
#include <gonio/io/measurements/spectral_samples.hpp>

#include <cstdlib>
#include <string>

namespace {

void read(fuzz::input bytes) {
  const auto given = gonio::io::read_spectral_sample_file(fuzz::text_of(bytes), fuzz::bytes_name);
  gonio::require_usable(given.samples);
  const std::string text = gonio::io::write_spectral_samples(given.samples, given.provenance);
  const auto again = gonio::io::read_spectral_sample_file(text, fuzz::bytes_name);
  if (again.samples.values != given.samples.values || again.samples.wavelengths != given.samples.wavelengths)
    std::abort();
}

const fuzz::registered harness("spectral_samples", &read);

}  // namespace
