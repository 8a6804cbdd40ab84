/// The seeds of the fuzzers and what they found, for each reader whose harness this program is linked with.

#include "limited_child.hpp"
#include "made_files.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

using crafted::byte_vector;
using crafted::bytes_of;

namespace {

byte_vector content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return bytes_of(std::string(std::istreambuf_iterator<char>(file), {}));
}

}  // namespace

TEST_CASE("small files that were made by hand, and those that fuzzers found, are read or refused") {
  std::size_t files = 0;
  for (const char* folder : {"seeds", "found"})
    for (const fuzz::reader& reader : fuzz::readers()) {
      const std::filesystem::path here =
          std::filesystem::path(GONIO_SOURCE_DIR) / "tests" / "fuzz" / folder / reader.name;
      if (!std::filesystem::exists(here)) continue;
      for (const auto& entry : std::filesystem::directory_iterator(here)) {
        INFO(entry.path());
        const crafted::report result = crafted::read_in_child(reader, content_of(entry.path()));
        // Seeds are of the kind, or a fuzzer would begin with nothing; one grazes the surface.
        if (folder == std::string("seeds") && entry.path().filename() != "directions.csv")
          CHECK_MESSAGE(result.how == crafted::outcome::read, result.message);
        ++files;
      }
    }
  CHECK(files >= 2 * fuzz::readers().size());
}
