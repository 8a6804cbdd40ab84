#include "scratch.hpp"
#include <gonio/io/exr.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>

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

}  // namespace

TEST_CASE("OpenEXR: what was written is read, bit for bit") {
  const gonio::image picture = unusual_image();
  CHECK(gonio::io::parse_exr(written_exr(picture), "a.exr") == picture);
  rc::check("images of any size come back", [] {
    const auto rows = *rc::gen::inRange<std::size_t>(1, 40), columns = *rc::gen::inRange<std::size_t>(1, 40);
    gonio::image some = gonio::uniform_image(rows, columns);
    for (float& value : some) value = static_cast<float>(*rc::gen::inRange(-1000000, 1000000)) / 7.0f;
    RC_ASSERT(gonio::io::parse_exr(written_exr(some), "a.exr") == some);
  });
}

TEST_CASE("OpenEXR: bad files and images are refused") {
  const std::vector<std::byte> whole = written_exr(unusual_image());
  const auto parse = [](std::span<const std::byte> bytes) { return gonio::io::parse_exr(bytes, "a.exr"); };
  check_refused([&] { return parse(scratch::bytes_of("no image")); }, {"a.exr", "cannot be decoded as OpenEXR"});
  check_refused([&] { return parse(std::span(whole).first(60)); }, {"a.exr"});
  check_refused([&] { return parse(std::span(whole).first(whole.size() - 5)); }, {"a.exr"});
  // Without its red channel, which is renamed.
  std::vector<std::byte> renamed = whole;
  const std::string text(reinterpret_cast<const char*>(whole.data()), whole.size());
  const auto red = text.find(std::string("\0R\0", 3));
  REQUIRE(red != std::string::npos);
  renamed[red + 1] = std::byte{'S'};
  check_refused([&] { return parse(renamed); }, {"a.exr", "neither channels R, G and B nor Y"});
  // An attribute that claims more than the file has, for which OpenEXR would reserve a gigabyte.
  std::vector<std::byte> attribute = whole;
  const auto order = text.find(std::string("lineOrder\0lineOrder\0", 20));
  REQUIRE(order != std::string::npos);
  attribute[order] = std::byte{'L'};  // one that OpenEXR does not know
  attribute[order + 10] = std::byte{'L'};
  attribute[order + 23] = std::byte{0x40};
  check_refused([&] { return parse(attribute); }, {"a.exr", "cannot be decoded as OpenEXR"});
  // A size that is claimed.
  std::vector<std::byte> huge = whole;
  huge.resize(4096);
  const auto window = text.find("dataWindow");
  REQUIRE(window != std::string::npos);
  const std::size_t right = window + 10 + 1 + 5 + 1 + 4 + 8;  // names, their ends, a size, and the upper left corner
  huge[right] = huge[right + 4] = std::byte{0xFF};            // 256 rows
  huge[right + 1] = std::byte{0x3F};                          // of 16384 columns
  check_refused([&] { return parse(huge); }, {"a.exr", "not believable"});
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
                                 [](auto bytes) { return gonio::io::parse_exr(bytes, "a.exr"); });
}
