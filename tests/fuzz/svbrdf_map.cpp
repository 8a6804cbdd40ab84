/// Maps of spatially varying BRDFs. The header's checksum is put right, which fuzzers do not find; bands are read as
/// they are.

#include "harness.hpp"
#include <gonio/io/materials/svbrdf_map.hpp>

#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <vector>

namespace {

void read(fuzz::input bytes) {
  constexpr std::size_t start = 20;
  std::vector<std::byte> file(bytes.begin(), bytes.end());
  std::uint32_t rest = 0;
  if (file.size() >= start) std::memcpy(&rest, file.data() + start - sizeof rest, sizeof rest);
  const std::size_t head = start + rest;
  if (head <= file.size()) {
    const auto sum = static_cast<std::uint32_t>(
        crc32_z(0, reinterpret_cast<const Bytef*>(file.data()), head - sizeof(std::uint32_t)));
    std::memcpy(file.data() + head - sizeof sum, &sum, sizeof sum);
  }
  const fuzz::memory_file stored{file};
  const gonio::io::svbrdf_map map(stored.path());
  for (Eigen::Index band = 0; band < map.header().bands(); ++band) static_cast<void>(map.read_band(band));
}

const fuzz::registered harness("svbrdf_map", &read);

}  // namespace
