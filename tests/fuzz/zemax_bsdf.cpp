/// Zemax's tabular BSDF, as samples and as a material.

#include "harness.hpp"
#include <gonio/core/error.hpp>
#include <gonio/io/measurements/zemax_bsdf.hpp>
#include <gonio/io/measurements/zemax_table.hpp>

namespace {

void read(fuzz::input bytes) {
  try {
    static_cast<void>(gonio::io::read_zemax_table(fuzz::text_of(bytes), fuzz::bytes_name));
  } catch (const gonio::error&) {  // the angles of samples need not ascend
  }
  static_cast<void>(gonio::io::read_zemax_bsdf(fuzz::text_of(bytes), fuzz::bytes_name));
}

const fuzz::registered harness("zemax_bsdf", &read);

}  // namespace
