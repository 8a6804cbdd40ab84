#include "scratch.hpp"
#include <gonio/io/text/named_files.hpp>

#include <doctest/doctest.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace {

constexpr std::array<std::string_view, 2> extensions{".binary", ".binary.gz"};

std::vector<std::string> names_in(const scratch::folder& here) {
  std::vector<std::string> names;
  for (const auto& file : gonio::io::list_named_files(here.path(), extensions, "table")) names.push_back(file.name);
  return names;
}

}  // namespace

TEST_CASE("named files: files are sorted by name, extensions may have any case, other files are ignored") {
  const scratch::folder here;
  for (const char* name : {"steel.binary", "Brass.BINARY", "a.b.Binary.gz", "notes.txt", ".binary", "binary"})
    scratch::put(here / name, std::string("x"));
  CHECK(names_in(here) == std::vector<std::string>{"Brass", "a.b", "steel"});
  const auto files = gonio::io::list_named_files(here.path(), extensions, "table");
  CHECK(files.front().path == here / "Brass.BINARY");
}

TEST_CASE("named files: a folder without such files, equal names and a missing folder are refused") {
  const scratch::folder here;
  scratch::put(here / "notes.txt", std::string("x"));
  scratch::check_refused([&] { return names_in(here); },
                         {here.path().string(), "holds no table (.binary or .binary.gz)"});
  scratch::put(here / "steel.binary", std::string("x"));
  scratch::put(here / "steel.BINARY.gz", std::string("x"));
  scratch::check_refused([&] { return names_in(here); },
                         {here.path().string(), "two files differ only in their extension: 'steel'"});
  scratch::check_refused([&] { return gonio::io::list_named_files(here / "absent", extensions, "table"); },
                         {"absent", "cannot be read as a folder"});
}
