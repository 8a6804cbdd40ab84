#pragma once
/// The files of examples/data that CMake puts into the program: none unless GONIO_EMBED_DATA is on.

#include <cstddef>
#include <span>
#include <string_view>

namespace cli {

struct built_in_file {
  std::string_view name;  ///< its path in examples/data
  std::span<const std::byte> bytes;
};

[[nodiscard]] std::span<const built_in_file> built_in_files();

}  // namespace cli
