/// Arrays of one to three dimensions.

#include "harness.hpp"
#include <gonio/io/bytes/npy.hpp>

namespace {

/// Calls `act`; what it refuses is refused.
template <class Act>
bool accepts(Act&& act) {
  try {
    static_cast<void>(act());
    return true;
  } catch (const gonio::error& refusal) {
    if (!fuzz::fault_of(refusal).empty()) throw;
    return false;
  }
}

void read(fuzz::input bytes) {
  using gonio::io::read_npy;
  if (accepts([&] { return read_npy<float, 1>(bytes, fuzz::bytes_name); })) return;
  if (accepts([&] { return read_npy<double, 2>(bytes, fuzz::bytes_name); })) return;
  static_cast<void>(read_npy<float, 3>(bytes, fuzz::bytes_name));
}

const fuzz::registered harness("npy", &read);

}  // namespace
