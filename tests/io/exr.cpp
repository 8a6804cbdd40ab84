#include "exr_of_others.hpp"
#include "scratch.hpp"
#include <gonio/io/images/exr.hpp>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

using scratch::check_refused;

namespace {

/// A colour image with values that HDR files cannot hold.
gonio::image unusual_image() {
  gonio::image picture = gonio::uniform_image(3, 5, gonio::rgb(0.1, -2.5, 1e-30));
  gonio::set_pixel(picture, 2, 4, gonio::rgb(std::numeric_limits<double>::infinity(), 0.0, 3e38));
  return picture;
}

std::vector<std::byte> written_exr(const gonio::image& picture) {
  const scratch::folder here;
  gonio::io::write_exr(here / "a.exr", picture);
  return scratch::bytes_of(scratch::get(here / "a.exr"));
}

/// An image of distinct values.
gonio::image counted_image(std::size_t rows, std::size_t columns) {
  gonio::image picture = gonio::uniform_image(rows, columns);
  for (std::size_t i = 0; i < picture.size(); ++i) picture.data()[i] = static_cast<float>(i) / 16.0f;
  return picture;
}

}  // namespace

TEST_CASE("OpenEXR rows: any rows equal those of the whole image, for every kind of storage") {
  const scratch::folder here;
  const gonio::image whole = counted_image(70, 37);
  gonio::io::write_exr(here / "ours.exr", whole);
  put_lines(here / "plain.exr", whole, Imf::NO_COMPRESSION);
  put_lines(here / "wavelets.exr", whole, Imf::PIZ_COMPRESSION);
  put_lines(here / "upwards.exr", whole, Imf::ZIPS_COMPRESSION, Imf::DECREASING_Y);
  put_tiles(here / "tiles.exr", whole, 16);
  for (const char* name : {"ours.exr", "plain.exr", "wavelets.exr", "upwards.exr", "tiles.exr"}) {
    CAPTURE(name);
    const gonio::io::exr_rows file(here / name);
    REQUIRE(file.rows() == 70);
    REQUIRE(file.columns() == 37);
    for (const gonio::block rows : {gonio::block{30, 45}, {0, 1}, {69, 70}, {0, 70}, {3, 17}}) {
      std::vector<float> found(3 * 37 * static_cast<std::size_t>(rows.size()), -1.0f);
      file.read(rows, found);
      CHECK(std::equal(found.begin(), found.end(), whole.data() + 3 * 37 * rows.begin));
    }
  }
}

TEST_CASE("OpenEXR rows: NaN is kept; a channel Y alone is grey") {
  const scratch::folder here;
  gonio::image picture = counted_image(20, 3);
  picture(17, 2, 1) = std::numeric_limits<float>::quiet_NaN();
  put_lines(here / "a.exr", picture, Imf::ZIP_COMPRESSION);
  std::vector<float> row(9);
  gonio::io::exr_rows(here / "a.exr").read({17, 18}, row);
  CHECK(std::isnan(row[7]));
  CHECK(row[8] == picture(17, 2, 2));
  Imf::Header header(1, 2);
  header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
  std::vector<float> grey{0.25f, 0.5f};
  Imf::FrameBuffer buffer;
  buffer.insert("Y", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(grey.data()), 4, 4));
  {
    Imf::OutputFile file((here / "grey.exr").c_str(), header, 0);
    file.setFrameBuffer(buffer);
    file.writePixels(2);
  }
  std::vector<float> pixel(3);
  gonio::io::exr_rows(here / "grey.exr").read({1, 2}, pixel);
  CHECK(pixel == std::vector<float>(3, 0.5f));
}

TEST_CASE("OpenEXR rows: truncated files, false sizes and huge tiles are refused") {
  const scratch::folder here;
  const auto refused = [&](const std::string& content, std::initializer_list<std::string> words) {
    scratch::put(here / "a.exr", content);
    check_refused([&] { return gonio::io::exr_rows(here / "a.exr"); }, words);
  };
  put_lines(here / "lines.exr", counted_image(70, 37), Imf::ZIP_COMPRESSION);
  put_tiles(here / "tiles.exr", counted_image(70, 37), 16);
  put_tiles(here / "narrow.exr", counted_image(70, 5), 16);
  for (const char* name : {"lines.exr", "tiles.exr", "narrow.exr"}) {
    const std::string whole = scratch::get(here / name);
    for (const std::size_t cut : {std::size_t{1}, std::size_t{100}, whole.size() / 2, whole.size() - 100})
      refused(whole.substr(0, whole.size() - cut), {"a.exr: cannot be decoded as OpenEXR"});
    // Claim more lines than the file has: their blocks are missing.
    std::string lying = whole;
    const auto window = lying.find("dataWindow");
    REQUIRE(window != std::string::npos);
    const std::size_t bottom = window + 10 + 1 + 5 + 1 + 4 + 12;
    REQUIRE(lying[bottom] == 69);
    lying[bottom] = 100;
    refused(lying, {"a.exr: cannot be decoded as OpenEXR"});
  }
  put_tiles(here / "huge.exr", counted_image(70, 37), 1024);
  check_refused([&] { return gonio::io::exr_rows(here / "huge.exr"); }, {"huge.exr: its tiles have 1024 rows", "512"});
  scratch::check_refuses_non_files([](const auto& path) { return gonio::io::exr_rows(path); });
}

TEST_CASE("OpenEXR rows: damaged files are read or refused") {
  const scratch::folder here;
  put_lines(here / "lines.exr", counted_image(40, 5), Imf::ZIP_COMPRESSION);
  put_tiles(here / "tiles.exr", counted_image(40, 5), 16);
  for (const char* name : {"lines.exr", "tiles.exr"})
    scratch::check_survives_damage(scratch::bytes_of(scratch::get(here / name)), 1000, [&](auto bytes) {
      scratch::put(here / "a.exr", bytes);
      const gonio::io::exr_rows file(here / "a.exr");
      std::vector<float> found(static_cast<std::size_t>(3 * file.columns()));
      for (Eigen::Index row = 0; row < file.rows(); row += 7) file.read({row, row + 1}, found);
      return found;
    });
}

TEST_CASE("OpenEXR: images are read back bit for bit") {
  const gonio::image picture = unusual_image();
  CHECK(gonio::io::read_exr(written_exr(picture), "a.exr") == picture);
  CHECK(rc::check("images of any size come back", [] {
    const auto rows = *rc::gen::inRange<std::size_t>(1, 40), columns = *rc::gen::inRange<std::size_t>(1, 40);
    gonio::image some = gonio::uniform_image(rows, columns);
    for (float& value : some) value = static_cast<float>(*rc::gen::inRange(-1000000, 1000000)) / 7.0f;
    RC_ASSERT(gonio::io::read_exr(written_exr(some), "a.exr") == some);
  }));
}

TEST_CASE("OpenEXR: bad files and images are refused") {
  const std::vector<std::byte> whole = written_exr(unusual_image());
  const auto read = [](std::span<const std::byte> bytes) { return gonio::io::read_exr(bytes, "a.exr"); };
  check_refused([&] { return read(scratch::bytes_of("no image")); }, {"a.exr", "cannot be decoded as OpenEXR"});
  check_refused([&] { return read(std::span(whole).first(60)); }, {"a.exr"});
  check_refused([&] { return read(std::span(whole).first(whole.size() - 5)); }, {"a.exr"});
  // Rename the red channel.
  std::vector<std::byte> renamed = whole;
  const std::string text(reinterpret_cast<const char*>(whole.data()), whole.size());
  const auto red = text.find(std::string("\0R\0", 3));
  REQUIRE(red != std::string::npos);
  renamed[red + 1] = std::byte{'S'};
  check_refused([&] { return read(renamed); }, {"a.exr", "neither channels R, G and B nor Y"});
  // An attribute claims more bytes than the file has; OpenEXR would allocate a gigabyte.
  std::vector<std::byte> attribute = whole;
  const auto order = text.find(std::string("lineOrder\0lineOrder\0", 20));
  REQUIRE(order != std::string::npos);
  attribute[order] = std::byte{'L'};  // unknown to OpenEXR
  attribute[order + 10] = std::byte{'L'};
  attribute[order + 23] = std::byte{0x40};
  check_refused([&] { return read(attribute); }, {"a.exr", "cannot be decoded as OpenEXR"});
  // A large size is claimed.
  std::vector<std::byte> huge = whole;
  huge.resize(4096);
  const auto window = text.find("dataWindow");
  REQUIRE(window != std::string::npos);
  const std::size_t right = window + 10 + 1 + 5 + 1 + 4 + 8;  // names, their ends, a size, and the upper left corner
  huge[right] = huge[right + 4] = std::byte{0xFF};            // 256 rows
  huge[right + 1] = std::byte{0x3F};                          // of 16384 columns
  check_refused([&] { return read(huge); }, {"a.exr", "cannot fit in"});
  const scratch::folder here;
  gonio::image unknown = unusual_image();
  unknown(1, 2, 0) = std::numeric_limits<float>::quiet_NaN();
  check_refused(
      [&] {
        gonio::io::write_exr(here / "b.exr", unknown);
        return 0;
      },
      {"b.exr", "row 1, column 2"});
  CHECK(here.entries() == 0);
  scratch::check_refuses_non_files([](const auto& path) { return gonio::io::read_exr(path); });
}

TEST_CASE("OpenEXR: damaged files are read or refused") {
  scratch::check_survives_damage(written_exr(unusual_image()), 2000,
                                 [](auto bytes) { return gonio::io::read_exr(bytes, "a.exr"); });
}
