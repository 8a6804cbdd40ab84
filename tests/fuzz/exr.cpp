/// OpenEXR images, some rows at a time and whole.

#include "harness.hpp"
#include <gonio/io/images/exr.hpp>

#include <algorithm>
#include <vector>

namespace {

void read_rows(fuzz::input bytes) {
  const fuzz::memory_file stored(bytes);
  const gonio::io::exr_rows file(stored.path());
  std::vector<float> found;
  for (Eigen::Index row = 0; row < file.rows(); row += 13) {
    const gonio::block rows{row, std::min(row + 13, file.rows())};
    found.resize(static_cast<std::size_t>(3 * file.columns() * rows.size()));
    file.read(rows, found);
  }
}

void read(fuzz::input bytes) {
  try {
    read_rows(bytes);
  } catch (const gonio::error& refusal) {
    // The other refuses NaN, too, and this one large tiles.
    if (!fuzz::fault_of(refusal).empty()) throw;
  }
  static_cast<void>(gonio::io::read_exr(bytes, fuzz::bytes_name));
}

const fuzz::registered harness("exr", &read);

}  // namespace
