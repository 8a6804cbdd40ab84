/// The reflectance of a white reference by angles: what is accepted is a factor wherever the table covers.

#include "harness.hpp"
#include <gonio/io/measurements/reference_reflectance.hpp>

#include <cstdlib>

namespace {

void read(fuzz::input bytes) {
  const fuzz::memory_file file(bytes);
  const auto table = gonio::io::read_reference_reflectance(file.path());
  if (!(table.largest() > 0.0 && table.largest() <= table.largest_possible)) std::abort();
  const gonio::rgb factor = table.at({gonio::spherical_direction(0.5, 0.0), gonio::spherical_direction(1.0, 2.0)});
  if (!((factor > 0.0).all() && (factor <= table.largest() * (1.0 + 1e-9)).all())) std::abort();
}

const fuzz::registered harness("reference_reflectance", &read);

}  // namespace
