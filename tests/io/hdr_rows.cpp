#include "scratch.hpp"
#include <gonio/core/rgb.hpp>
#include <gonio/io/images/hdr_rows.hpp>
#include <gonio/io/images/image.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using scratch::check_refused;

namespace {

/// An image of runs and of differing pixels.
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

TEST_CASE("HDR rows: any rows equal those of the whole image") {
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

TEST_CASE("HDR rows: flat and run-length encoded rows are read") {
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
  // Flat rows of 8 pixels, although runs are possible.
  std::string flat;
  for (int i = 0; i < 16; ++i) flat += colour;
  CHECK(pixel(header("-Y 2 +X 8") + flat, 1, 7) == expected);
  // A run and 3 codes of each channel.
  std::string runs("\x02\x02\x00\x08", 4);
  for (const char code : colour) runs += std::string("\x85") + code + "\x03" + std::string(3, code);
  CHECK(pixel(header("-Y 1 +X 8") + runs, 0, 4) == expected);
  CHECK(pixel(header("-Y 2 +X 8") + runs + runs, 1, 5) == expected);
}

TEST_CASE("HDR rows: the header's colours and order of rows are applied") {
  const scratch::folder here;
  const auto pixel = [&](const std::string& lines, const std::string& code = colour) {
    scratch::put(here / "a.hdr", "#?RADIANCE\n" + lines + "\n-Y 1 +X 1\n" + code);
    return gonio::rgb(Eigen::Map<const Eigen::Array3f>(gonio::io::read_hdr(here / "a.hdr").data()).cast<double>());
  };
  const std::string rgbe = "FORMAT=32-bit_rle_rgbe\n", xyze = "FORMAT=32-bit_rle_xyze\n", white = "\x80\x80\x80\x81";
  const gonio::rgb stored(1.0, 0.5, 0.25);
  CHECK((pixel(rgbe + "EXPOSURE= 2.0\n") == stored / 2.0).all());
  // Programs append a line for each change.
  CHECK(
      (pixel("EXPOSURE=2\n" + rgbe + "EXPOSURE=4\nCOLORCORR= 1 2 4\n") == stored / gonio::rgb(8.0, 16.0, 32.0)).all());
  // Rec. 709's own primaries change nothing, and Radiance's keep white; its red is yellower.
  CHECK((pixel(rgbe + "PRIMARIES= .64 .33 .30 .60 .15 .06 .3127 .3290\n") - stored).abs().maxCoeff() < 2e-4);
  CHECK((pixel(rgbe + "PRIMARIES=0 0 0 0 0 0 0 0\n") == stored).all());
  const std::string radiance = rgbe + "PRIMARIES= .640 .330 .290 .600 .150 .060 .3333 .3333\n";
  CHECK((pixel(radiance, white) - 1.0).abs().maxCoeff() < 1e-6);
  const gonio::rgb red = pixel(radiance, std::string("\x80\x00\x00\x81", 4));
  CHECK(red[0] > 0.9);
  CHECK(std::abs(red[1]) < 0.1);
  CHECK((pixel(xyze) - gonio::from_xyz(stored) / 179.0).abs().maxCoeff() < 1e-8);

  scratch::put(here / "b.hdr", "#?RADIANCE\n" + rgbe + "\n+Y 3 +X 1\n" + colour + white + std::string(4, '\0'));
  const gonio::io::hdr_rows file(here / "b.hdr");
  std::vector<float> found(9);
  file.read({0, 3}, found);
  CHECK(found == std::vector<float>{0.0f, 0.0f, 0.0f, 1.0f, 1.0f, 1.0f, 1.0f, 0.5f, 0.25f});
  found.resize(6);
  file.read({1, 3}, found);
  CHECK(found[5] == 0.25f);
  CHECK(found[0] == 1.0f);
}

TEST_CASE("HDR rows: a dark first pixel does not begin a run-length encoded row") {
  const scratch::folder here;
  std::string flat("\x02\x02\x01\x70", 4);
  for (int i = 1; i < 8; ++i) flat += colour;
  scratch::put(here / "a.hdr", header("-Y 1 +X 8") + flat);
  const gonio::image found = gonio::io::read_hdr(here / "a.hdr");
  CHECK(found(0, 0, 0) > found(0, 0, 2));
  CHECK(found(0, 1, 0) == 1.0f);
}

TEST_CASE("HDR rows: bad files are refused") {
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
  refused(header("-Y 1 +X 8") + row + std::string(28, '\0'), {"a.hdr", "cannot be decoded (a run is empty"});
  refused(header("-Y 1 +X 8") + row + std::string(28, '\x7F'), {"a.hdr", "longer than its row"});
  std::string runs = row;
  for (int channel = 0; channel < 4; ++channel) runs += std::string("\x88\x7F");
  refused(header("-Y 2 +X 8") + runs + std::string("\x02\x02\x00\x09", 4) + std::string(28, '\x7F'),
          {"a.hdr", "begin with a run-length header"});
  refused(header("-Y 2 +X 8") + runs + std::string(28, '\x7F'), {"a.hdr", "begin with a run-length header"});
  const auto headed = [](const std::string& lines) {
    return "#?RADIANCE\n" + lines + "\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" + colour;
  };
  refused(headed("EXPOSURE=bright"), {"a.hdr: the line 'EXPOSURE'", "must hold 1 number"});
  refused(headed("COLORCORR=1 2"), {"a.hdr: the line 'COLORCORR'", "must hold 3 numbers"});
  refused(headed("EXPOSURE=0"), {"a.hdr", "must be positive"});
  refused(headed("PRIMARIES=.3 .3 .3 .3 .3 .3 .3 .3"), {"a.hdr", "PRIMARIES", "not three colours"});
  refused("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-X 1 +Y 1\n" + colour, {"a.hdr", "-Y or +Y"});
  scratch::check_refuses_non_files([](const auto& path) { return gonio::io::hdr_rows(path); });
}
