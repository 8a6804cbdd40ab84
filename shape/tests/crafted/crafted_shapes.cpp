/// Adversarial meshes and shape models (tests/crafted/crafted_files.cpp).

#include "crafted/made_files.hpp"
#include "crafted/refusals.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <limits>
#include <string>

using crafted::refuses;

TEST_CASE("a shape model's counts are not believed before its bytes are there") {
  constexpr std::uint32_t most = 0xFFFFFFFF;
  refuses("shape_model", crafted::shapes_of({1, 1, 1, 100'000'000}, 100'000'000), "cannot fit in");
  refuses("shape_model", crafted::shapes_of({1, 1, 1, 2'000'000 - 100}, 2'000'000), "counts are wrong");
  refuses("shape_model", crafted::shapes_of({most, most, most, most}, 7 << 20), "counts are wrong");
  // In 64 bits, 3 x vertices x components overflows to a few bytes.
  refuses("shape_model", crafted::shapes_of({1u << 31, 1, 1u << 31, 1u << 31}, 7 << 20), "counts are wrong");
  refuses("shape_model", crafted::shapes_of({200'000, 300'000, 1, 1}, 8 + 8 + 3'600'000 + 12 + 4'800'000),
          "one vertex twice");
}

TEST_CASE("a mesh's counts are not believed before its bytes are there") {
  const std::string vertices =
      "ply\nformat binary_little_endian 1.0\nelement vertex 2147483647\nproperty float x\n"
      "property float y\nproperty float z\nelement face 18446744073709551615\n"
      "property list uint int vertex_indices\nend_header\n";
  refuses("ply", vertices, "truncated");
  refuses("ply",
          "ply\nformat ascii 1.0\nelement face 18446744073709551615\nproperty list uint int vertex_indices\n"
          "end_header\n4294967295 0 0 0\n",
          "vertex 0, expected at least 0 and less than 0");
  refuses("ply", "ply\nformat ascii 1.0\nelement other 9\nproperty list uint int x\nend_header\n4294967295 0 0 0\n",
          "ends before");
  refuses("obj", "v 0 0 0\nf 1 1 9223372036854775807\n", "names vertex");
}
