#include "scratch.hpp"
#include <gonio/io/images/pnm.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

using gonio::stored_codes;
using gonio::io::read_pnm;
using scratch::bytes_of;
using scratch::check_refused;

namespace {

stored_codes read_text(const std::string& text) { return read_pnm(bytes_of(text), "some.ppm"); }

}  // namespace

TEST_CASE("Netpbm: known bytes give known counts") {
  const stored_codes colour = read_text("P6 2 1 255\n\x01\x02\x03\xFF\x05\x06");
  CHECK((colour.rows == 1 && colour.columns == 2 && colour.largest == 255));
  CHECK(colour.values == std::vector<std::uint16_t>{1, 2, 3, 255, 5, 6});
  // 16 bits have the high byte first; grey becomes three equal channels; comments may stand between numbers.
  const stored_codes grey = read_text("P5\n# by hand\n1 2\n#again\n4095\n\x0F\xFF\x01\x02");
  CHECK((grey.rows == 2 && grey.columns == 1 && grey.largest == 4095));
  CHECK(grey.values == std::vector<std::uint16_t>{4095, 4095, 4095, 258, 258, 258});
}

TEST_CASE("Netpbm: a written file is read back") {
  const scratch::folder here;
  CHECK(rc::check("counts of any size and depth come back", [&] {
    stored_codes codes{*rc::gen::inRange<std::size_t>(1, 6), *rc::gen::inRange<std::size_t>(1, 6), 0, {}};
    codes.largest = *rc::gen::element<std::uint16_t>(1, 255, 256, 4095, 65535);
    codes.values = *rc::gen::container<std::vector<std::uint16_t>>(3 * codes.rows * codes.columns,
                                                                   rc::gen::inRange<std::uint16_t>(0, codes.largest));
    gonio::io::write_pnm(here / "frame.ppm", codes);
    const stored_codes back = gonio::io::read_pnm(here / "frame.ppm");
    RC_ASSERT(back.values == codes.values);
    RC_ASSERT((back.rows == codes.rows && back.columns == codes.columns && back.largest == codes.largest));
  }));
}

TEST_CASE("Netpbm: bad files are refused") {
  const auto refuses = [](const std::string& text, const std::string& words) {
    check_refused([&] { return read_text(text); }, {"some.ppm", words});
  };
  refuses("P3 1 1 255\n1 2 3", "not a binary PPM or PGM");
  refuses("P6 1", "truncated");
  refuses("P6 1 1 255", "truncated");
  refuses("P6 # no end", "truncated");
  refuses("P6 one 1 255\n123", "lacks a number");
  refuses("P6 123456 1 255\n", "five digits");
  refuses("P6 16385 1 255\n", "from 1 to 16384");
  refuses("P6 0 1 255\n", "from 1 to 16384");
  refuses("P6 16384 16384 65535\n1", "expected 1610612736");
  refuses("P6 1 1 0\n123", "largest count is 0");
  refuses("P6 1 1 65536\n123456", "largest count is 65536");
  refuses("P6 1 1 255\n12", "has 2 bytes of pixels, expected 3");
  refuses("P6 1 1 255\n1234", "has 4 bytes");
  refuses("P6 1 1 100\n12\xC8", "counts 200, more than the largest count in its header, 100");
  const scratch::folder here;
  check_refused(
      [&] {
        gonio::io::write_pnm(here / "a.ppm", {1, 1, 255, {1, 2}});
        return 0;
      },
      {"a.ppm", "2 counts"});
  check_refused(
      [&] {
        gonio::io::write_pnm(here / "a.ppm", {1, 1, 255, {1, 2, 256}});
        return 0;
      },
      {"above the largest"});
  CHECK(here.entries() == 0);
  scratch::check_refuses_non_files([](const auto& path) { return gonio::io::read_pnm(path); });
}

TEST_CASE("Netpbm: damaged files are read or refused") {
  std::string file = "P6\n3 2\n4095\n";
  for (int i = 0; i < 18; ++i) file += {static_cast<char>(i % 16), static_cast<char>(7 * i)};
  scratch::check_survives_damage(bytes_of(file), 2000, [](auto bytes) { return read_pnm(bytes, "some.ppm"); });
}
