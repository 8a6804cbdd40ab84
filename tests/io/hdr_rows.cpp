#include "scratch.hpp"
#include <gonio/io/images/hdr_rows.hpp>
#include <gonio/io/images/image.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

using scratch::check_refused;

namespace {

/// Runs, and pixels that differ.
gonio::image stripes(std::size_t rows, std::size_t columns) {
  gonio::image picture({rows, columns, std::size_t{3}});
  for (std::size_t i = 0; i < picture.size(); ++i)
    picture.data()[i] = i / 3 % 7 < 4 ? 0.5f : static_cast<float>(i * i % 251) / 64.0f;
  return picture;
}

std::string header(const std::string& size) { return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + size + "\n"; }

/// A pixel of red 1, green 0.5 and blue 0.25.
const std::string colour = "\x80\x40\x20\x81";

}  // namespace

TEST_CASE("HDR rows: any rows are those of the whole image") {
  const scratch::folder here;
  for (const std::size_t columns : {3u, 40u, 700u}) {
    gonio::io::write_hdr(here / "a.hdr", stripes(9, columns));
    const gonio::image whole = gonio::io::read_hdr(here / "a.hdr");
    const gonio::io::hdr_rows file(here / "a.hdr");
    REQUIRE(file.rows() == 9);
    REQUIRE(file.columns() == static_cast<Eigen::Index>(columns));
    for (const gonio::block rows : {gonio::block{4, 7}, {0, 1}, {8, 9}, {0, 9}, {5, 5}}) {
      std::vector<float> found(3 * columns * static_cast<std::size_t>(rows.size()), -1.0f);
      file.read(rows, found);
      CHECK(std::equal(found.begin(), found.end(), whole.data() + 3 * columns * static_cast<std::size_t>(rows.begin)));
    }
  }
}

TEST_CASE("HDR rows: what is stored, flat and in runs") {
  const scratch::folder here;
  const auto pixel = [&](const std::string& content, Eigen::Index row, std::size_t column) {
    scratch::put(here / "a.hdr", content);
    const gonio::io::hdr_rows file(here / "a.hdr");
    std::vector<float> found(3 * static_cast<std::size_t>(file.columns()));
    file.read({row, row + 1}, found);
    return std::vector<float>(found.begin() + 3 * static_cast<std::ptrdiff_t>(column),
                              found.begin() + 3 * static_cast<std::ptrdiff_t>(column) + 3);
  };
  const std::vector<float> expected{1.0f, 0.5f, 0.25f};
  CHECK(pixel(header("-Y 2 +X 1") + std::string(4, '\0') + colour, 1, 0) == expected);
  CHECK(pixel(header("-Y 2 +X 1") + std::string(4, '\0') + colour, 0, 0) == std::vector<float>(3, 0.0f));
  // Rows of 8 pixels as they are, though runs are possible.
  std::string flat;
  for (int i = 0; i < 16; ++i) flat += colour;
  CHECK(pixel(header("-Y 2 +X 8") + flat, 1, 7) == expected);
  // A run and 3 codes of each channel.
  std::string runs("\x02\x02\x00\x08", 4);
  for (const char code : colour) runs += std::string("\x85") + code + "\x03" + std::string(3, code);
  CHECK(pixel(header("-Y 1 +X 8") + runs, 0, 4) == expected);
  CHECK(pixel(header("-Y 2 +X 8") + runs + runs, 1, 5) == expected);
}

TEST_CASE("HDR rows: files that say more than they have are refused") {
  const scratch::folder here;
  const auto refused = [&](const std::string& content, std::initializer_list<std::string> words) {
    scratch::put(here / "a.hdr", content);
    check_refused([&] { return gonio::io::hdr_rows(here / "a.hdr"); }, words);
  };
  gonio::io::write_hdr(here / "valid.hdr", stripes(4, 40));
  std::string lying = scratch::get(here / "valid.hdr");
  lying.replace(lying.find("-Y 4"), 4, "-Y 5");
  refused(lying, {"a.hdr: the HDR file is truncated"});
  lying.replace(lying.find("-Y 5"), 4, "-Y 3");
  refused(lying, {"a.hdr: ", "bytes follow the end"});
  std::string second(scratch::get(here / "valid.hdr"));
  refused(second.substr(0, second.size() - 1), {"a.hdr: the HDR file is truncated"});
  const std::string row("\x02\x02\x00\x08", 4);
  refused(header("-Y 1 +X 8") + row + std::string(28, '\0'), {"a.hdr", "cannot be decoded (a run has no pixel"});
  refused(header("-Y 1 +X 8") + row + std::string(28, '\x7F'), {"a.hdr", "leaves its row"});
  refused(header("-Y 1 +X 9") + row + std::string(28, '\x7F'), {"a.hdr", "begin as a row of runs"});
  scratch::check_refuses_non_files([](const auto& path) { return gonio::io::hdr_rows(path); });
}
