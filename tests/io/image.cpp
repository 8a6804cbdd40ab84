#include "scratch.hpp"
#include <gonio/io/images/image.hpp>

#include <rapidcheck.h>

using gonio::image;
using gonio::io::read_hdr;
using gonio::io::read_png;
using gonio::io::write_hdr;
using gonio::io::write_png;
using scratch::check_refused;

namespace {

/// Every channel of every pixel differs.
image gradient(std::size_t rows, std::size_t columns, float scale = 1.0f) {
  image picture({rows, columns, std::size_t{3}});
  for (std::size_t i = 0; i < picture.size(); ++i)
    picture.data()[i] = scale * static_cast<float>(i) / static_cast<float>(picture.size());
  return picture;
}

float largest_difference(const image& a, const image& b) {
  REQUIRE(a.shape() == b.shape());
  float largest = 0.0f;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a.data()[i] - b.data()[i]));
  return largest;
}

std::string big_endian(std::size_t value) {
  return {static_cast<char>(value >> 24 & 255), static_cast<char>(value >> 16 & 255),
          static_cast<char>(value >> 8 & 255), static_cast<char>(value & 255)};
}

std::string chunk(const std::string& type, const std::string& data) {
  const std::string checked = type + data;
  return big_endian(data.size()) + checked +
         big_endian(crc32_z(0, reinterpret_cast<const Bytef*>(checked.data()), checked.size()));
}

std::string deflated(const std::string& text) {
  const auto bytes = gonio::io::compress_bytes(std::as_bytes(std::span(text)));
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string png_header(std::size_t columns, std::size_t rows, char depth = 8, char type = 2, char interlaced = 0) {
  return "\x89PNG\r\n\x1a\n" +
         chunk("IHDR", big_endian(columns) + big_endian(rows) + depth + type + '\0' + '\0' + interlaced);
}

std::string png(const std::string& header, const std::string& rows) {
  return header + chunk("IDAT", deflated(rows)) + chunk("IEND", "");
}

}  // namespace

TEST_CASE("PNG holds sRGB, rounded and clipped") {
  const scratch::folder here;
  image picture({std::size_t{1}, std::size_t{4}, std::size_t{3}}, 0.0f);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    picture(0, 1, channel) = 0.2140411f;  // just below code 127.5 of 255, 0.21404114
    picture(0, 2, channel) = 7.0f;
    picture(0, 3, channel) = -1.0f;
  }
  picture(0, 1, 0) = 0.5f;
  write_png(here / "a.png", picture);
  const image again = read_png(here / "a.png");
  CHECK(again.shape() == picture.shape());
  CHECK(again(0, 0, 0) == 0.0f);
  // 0.5 encodes to 187.516 of 255.
  CHECK(255.0 * gonio::encode_srgb(double{again(0, 1, 0)}) == doctest::Approx(188.0));
  CHECK(again(0, 2, 1) == 1.0f);
  CHECK(again(0, 3, 2) == 0.0f);
  CHECK(largest_difference(gradient(20, 30), [&] {
          write_png(here / "b.png", gradient(20, 30));
          return read_png(here / "b.png");
        }()) < 0.0045f);
}

TEST_CASE("a PNG in memory has the bytes of the file") {
  const scratch::folder here;
  write_png(here / "a.png", gradient(20, 30));
  const auto bytes = gonio::io::write_png(gradient(20, 30), "gradient");
  CHECK(scratch::get(here / "a.png") == std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  image picture = gradient(2, 2);
  picture(0, 0, 0) = std::numeric_limits<float>::quiet_NaN();
  check_refused([&] { return gonio::io::write_png(picture, "gradient"); }, {"gradient: pixel", "nan"});
}

TEST_CASE("a PNG is read and written again with the same bytes") {
  const scratch::folder here;
  CHECK(rc::check("png round trip", [&] {
    image picture({*rc::gen::inRange<std::size_t>(1, 12), *rc::gen::inRange<std::size_t>(1, 12), std::size_t{3}});
    for (std::size_t i = 0; i < picture.size(); ++i)
      picture.data()[i] = 0.001f * static_cast<float>(*rc::gen::inRange(-100, 1200));
    write_png(here / "a.png", picture);
    write_png(here / "b.png", read_png(here / "a.png"));
    RC_ASSERT(scratch::get(here / "a.png") == scratch::get(here / "b.png"));
  }));
}

TEST_CASE("grey, palette, alpha, 16 bits and interlaced PNGs are read") {
  const scratch::folder here;
  const auto read = [&](const std::string& content) {
    scratch::put(here / "a.png", content);
    return read_png(here / "a.png");
  };
  using namespace std::string_literals;
  const auto is_white = [](const image& picture) { return picture.size() == 12 && xt::allclose(picture, 1.0f); };
  CHECK(is_white(read(png(png_header(2, 2, 8, 0), "\0\xFF\xFF\0\xFF\xFF"s))));
  CHECK(is_white(read(png(png_header(2, 2, 1, 0), "\0\xC0\0\xC0"s))));
  CHECK(is_white(read(png(png_header(2, 2, 8, 4), "\0\xFF\x80\xFF\x80\0\xFF\x80\xFF\x80"s))));
  CHECK(
      is_white(read(png(png_header(2, 2, 16, 2), "\0"s + std::string(12, '\xFF') + "\0"s + std::string(12, '\xFF')))));
  CHECK(is_white(read(png(png_header(2, 2, 8, 6), "\0"s + std::string(8, '\xFF') + "\0"s + std::string(8, '\xFF')))));
  CHECK(is_white(read(png(png_header(2, 2, 8, 3) + chunk("PLTE", "\0\0\0\xFF\xFF\xFF"s), "\0\1\1\0\1\1"s))));
  // Adam7 of 2 x 2 pixels: passes 1, 6 and 7 have 1, 1 and 2 pixels.
  CHECK(is_white(read(png(png_header(2, 2, 8, 0, 1), "\0\xFF\0\xFF\0\xFF\xFF"s))));
}

TEST_CASE("PNG codes of 8 and of 16 bits are read unchanged") {
  const scratch::folder here;
  using namespace std::string_literals;
  scratch::put(here / "a.png", png(png_header(2, 1, 16, 2), "\0\x12\x34\0\1\xFF\xFF\0\0\x0F\xA0\x80\0"s));
  const auto deep = gonio::io::read_png_codes(here / "a.png");
  CHECK(deep.largest == 65535);
  CHECK((deep.rows == 1 && deep.columns == 2));
  CHECK(deep.values == std::vector<std::uint16_t>{0x1234, 1, 0xFFFF, 0, 0x0FA0, 0x8000});
  CHECK(deep.at(0, 1, 2) == 0x8000);
  scratch::put(here / "a.png", png(png_header(2, 1, 16, 0), "\0\x12\x34\0\1"s));
  CHECK(gonio::io::read_png_codes(here / "a.png").values ==
        std::vector<std::uint16_t>{0x1234, 0x1234, 0x1234, 1, 1, 1});
  scratch::put(here / "a.png", png(png_header(1, 2), "\0\1\2\3\0\xFD\xFE\xFF"s));
  const auto shallow = gonio::io::read_png_codes(here / "a.png");
  CHECK(shallow.largest == 255);
  CHECK(shallow.values == std::vector<std::uint16_t>{1, 2, 3, 253, 254, 255});
  scratch::check_refuses_non_files([](const auto& path) { return gonio::io::read_png_codes(path); });
  scratch::put(here / "a.png", "plain text");
  check_refused([&] { return gonio::io::read_png_codes(here / "a.png"); }, {"a.png: ", "not a PNG"});
}

TEST_CASE("bad PNG files are refused") {
  const scratch::folder here;
  scratch::check_refuses_non_files([](const auto& path) { return read_png(path); });
  const auto refused = [&](const std::string& content, std::initializer_list<std::string> words) {
    scratch::put(here / "a.png", content);
    check_refused([&] { return read_png(here / "a.png"); }, {"a.png: "});
    check_refused([&] { return read_png(here / "a.png"); }, words);
  };
  write_png(here / "valid.png", gradient(5, 7));
  const std::string valid = scratch::get(here / "valid.png");
  for (std::size_t size = 0; size < valid.size(); ++size)
    refused(valid.substr(0, size), {size < 8 ? "not a PNG" : "truncated"});
  refused(valid + "x", {"1 bytes follow the end"});
  refused("plain text", {"not a PNG"});
  for (std::size_t i = 8; i < valid.size(); ++i) {
    std::string changed = valid;
    changed[i] = static_cast<char>(changed[i] ^ 4);
    refused(changed, {});
  }
  const std::string row(1 + 3 * 2, '\0');
  refused(png(png_header(2, 1), row.substr(1)), {"expands to 6 bytes", "expected 7"});
  refused(png(png_header(2, 1), row + "x"), {"more than the expected 7"});
  refused(png(png_header(0, 1), row), {"0 x 1 pixels"});
  refused(png(png_header(1, 16385), row), {"1 x 16385 pixels", "from 1 to 16384"});
  refused(png(png_header(0xFFFFFFFF, 0xFFFFFFFF), row), {"4294967295", "from 1 to 16384"});
  refused(png(png_header(16384, 16384), row), {"16384 x 16384 pixels cannot fit in 68 bytes"});
  refused(png(png_header(2, 1, 8, 1), row), {"colour type 1"});
  refused(png(png_header(2, 1, 8, 7), row), {"colour type 7"});
  refused(png(png_header(2, 1, 3, 2), row), {"3 bits"});
  refused(png_header(2, 1) + chunk("IEND", ""), {"truncated"});
  refused(png_header(2, 1) + png(png_header(2, 1), row).substr(8), {"header is missing or appears twice"});
  refused("\x89PNG\r\n\x1a\n" + chunk("IEND", ""), {"header is missing"});
  refused("\x89PNG\r\n\x1a\n" + chunk("IHDR", "short") + chunk("IEND", ""), {"header has 5 bytes", "expected 13"});
  refused(png(png_header(2, 1) + chunk("ABCD", ""), row), {"cannot be decoded"});
  refused(png(png_header(2, 1), "\7" + row.substr(1)), {"cannot be decoded"});
}

TEST_CASE("damaged PNG files are read or refused") {
  const scratch::folder here;
  write_png(here / "a.png", gradient(9, 11));
  scratch::check_survives_damage(gonio::io::read_bytes(here / "a.png"), 500, [&](auto bytes) {
    scratch::put(here / "a.png", bytes);
    return read_png(here / "a.png");
  });
  // With correct checksums the damage reaches stb.
  std::mt19937 random(1);
  for (int round = 0; round < 500; ++round) {
    std::string rows;
    for (int i = 0; i < 5 * (1 + 3 * 4); ++i) rows += static_cast<char>(random() % (i % 13 == 0 ? 6 : 256));
    const std::string header =
        png_header(4, 5, static_cast<char>(random() % 2 ? 8 : random() % 17),
                   static_cast<char>(random() % 2 ? 2 : random() % 7), static_cast<char>(random() % 2));
    const std::string palette = random() % 2 ? chunk("PLTE", std::string(random() % 12, '\x40')) : "";
    const std::string transparent = random() % 4 ? "" : chunk("tRNS", std::string(random() % 8, '\x40'));
    scratch::put(here / "a.png", png(header + palette + transparent, rows));
    try {
      static_cast<void>(read_png(here / "a.png"));
    } catch (const gonio::error&) {
    }
  }
}

TEST_CASE("HDR holds three mantissas of eight bits, rounded") {
  const scratch::folder here;
  CHECK(rc::check("hdr round trip", [&] {
    image picture({*rc::gen::inRange<std::size_t>(1, 5), *rc::gen::inRange<std::size_t>(1, 40), std::size_t{3}});
    for (std::size_t i = 0; i < picture.size(); ++i) {
      const float mantissa = 0.0001f * static_cast<float>(*rc::gen::inRange(-1000, 10000));
      picture.data()[i] = std::ldexp(mantissa, *rc::gen::element(0, 0, 1, 20, -90, 100));
    }
    write_hdr(here / "a.hdr", picture);
    const image again = read_hdr(here / "a.hdr");
    RC_ASSERT(again.shape() == picture.shape());
    for (std::size_t i = 0; i < picture.size(); ++i) {
      const float* pixel = picture.data() + i / 3 * 3;
      const float largest = std::max({pixel[0], pixel[1], pixel[2], 0.0f});
      RC_ASSERT(std::abs(again.data()[i] - std::max(picture.data()[i], 0.0f)) <= largest / 256.0f + 1e-32f);
    }
    write_hdr(here / "b.hdr", again);
    RC_ASSERT(scratch::get(here / "a.hdr") == scratch::get(here / "b.hdr"));
  }));
}

TEST_CASE("extreme values in HDR") {
  const scratch::folder here;
  image picture({std::size_t{1}, std::size_t{8}, std::size_t{3}}, 0.0f);
  // The largest float below 1 rounds up to the next exponent.
  picture(0, 0, 0) = std::nextafter(1.0f, 0.0f);
  picture(0, 1, 0) = 1.6e38f;
  picture(0, 2, 0) = -3.0f;
  picture(0, 3, 0) = 1e-40f;
  write_hdr(here / "a.hdr", picture);
  const image again = read_hdr(here / "a.hdr");
  CHECK(again(0, 0, 0) == 1.0f);
  CHECK(again(0, 1, 0) == doctest::Approx(1.6e38f).epsilon(0.01));
  CHECK(again(0, 2, 0) == 0.0f);
  CHECK(again(0, 3, 0) == 0.0f);
}

TEST_CASE("bad HDR files are refused") {
  const scratch::folder here;
  scratch::check_refuses_non_files([](const auto& path) { return read_hdr(path); });
  const auto refused = [&](const std::string& content, std::initializer_list<std::string> words) {
    scratch::put(here / "a.hdr", content);
    check_refused([&] { return read_hdr(here / "a.hdr"); }, {"a.hdr: "});
    check_refused([&] { return read_hdr(here / "a.hdr"); }, words);
  };
  // Flat rows (narrow images) and rows of runs.
  for (const std::size_t columns : {3u, 40u}) {
    write_hdr(here / "valid.hdr", gradient(4, columns));
    const std::string valid = scratch::get(here / "valid.hdr");
    CHECK(read_hdr(here / "valid.hdr").shape(1) == columns);
    // A file cut within "+X 40" declares a smaller image.
    const std::size_t begin = valid.find("+X "), end = valid.find('\n', begin);
    for (std::size_t size = 0; size < valid.size(); ++size)
      refused(valid.substr(0, size), {size < 11      ? "not a Radiance"
                                      : size < begin ? "header"
                                      : size <= end  ? ""
                                                     : "truncated"});
    refused(valid + std::string(1, '\0'), {"1 bytes follow the end"});
    refused(valid + "more", {"4 bytes follow the end"});
  }
  const auto header = [](const std::string& size) { return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + size + "\n"; };
  refused("#?RADIANCE\nFORMAT=32-bit_rle_lab\n\n-Y 1 +X 1\nabcd", {"header"});
  refused("#?RADIANCE\n", {"header"});
  refused(header("+X 1 -Y 1") + "abcd", {"header"});
  refused(header("-Y -5 +X 1") + "abcd", {"1 x 0 pixels"});
  refused(header("-Y 0 +X 1") + "abcd", {"1 x 0 pixels"});
  refused(header("-Y 1 +X 99999") + "abcd", {"99999 x 1 pixels", "from 1 to 16384"});
  refused(header("-Y 16384 +X 16384") + "abcd", {"truncated"});
  refused(header("-Y 99999999999999999999 +X 1") + "abcd", {"pixels"});
  // A run longer than its row, a row of another length (read as pixels), and runs of length zero.
  refused(header("-Y 1 +X 8") + "\x02\x02" + std::string(1, '\0') + "\x08\xFF" + std::string(20, 'x'),
          {"cannot be decoded"});
  refused(header("-Y 1 +X 8") + "\x02\x02" + std::string(1, '\0') + "\x09\x89" + std::string(20, 'x'), {"truncated"});
  refused(header("-Y 1 +X 8") + "\x02\x02" + std::string(1, '\0') + "\x08" + std::string(20, '\0'),
          {"cannot be decoded"});
}

TEST_CASE("both signatures of HDR are known") {
  const scratch::folder here;
  write_hdr(here / "a.hdr", gradient(2, 9));
  const std::string radiance = scratch::get(here / "a.hdr");
  scratch::put(here / "b.hdr", "#?RGBE" + radiance.substr(10));
  CHECK(largest_difference(read_hdr(here / "a.hdr"), read_hdr(here / "b.hdr")) == 0.0f);
}

TEST_CASE("damaged HDR files are read or refused") {
  const scratch::folder here;
  for (const std::size_t columns : {3u, 40u}) {
    write_hdr(here / "a.hdr", gradient(6, columns));
    scratch::check_survives_damage(gonio::io::read_bytes(here / "a.hdr"), 1000, [&](auto bytes) {
      scratch::put(here / "a.hdr", bytes);
      return read_hdr(here / "a.hdr");
    });
  }
}

TEST_CASE("images that a file cannot hold are not written") {
  const scratch::folder here;
  scratch::put(here / "a", "old");
  const auto refused = [&](const image& picture, std::initializer_list<std::string> words) {
    check_refused(
        [&] {
          write_png(here / "a", picture);
          return 0;
        },
        words);
    check_refused(
        [&] {
          write_hdr(here / "a", picture);
          return 0;
        },
        words);
  };
  image picture = gradient(4, 5);
  picture(2, 3, 1) = std::numeric_limits<float>::quiet_NaN();
  refused(picture, {"a: pixel", "row 2", "column 3", "nan"});
  refused(image({std::size_t{0}, std::size_t{5}, std::size_t{3}}), {"a: ", "5 x 0 pixels"});
  refused(image({std::size_t{16385}, std::size_t{1}, std::size_t{3}}, 0.0f), {"a: ", "1 x 16385 pixels"});
  refused(image({std::size_t{1}, std::size_t{1}, std::size_t{4}}, 0.0f), {"a: ", "4 channels", "expected 3"});
  picture(2, 3, 1) = std::numeric_limits<float>::infinity();
  check_refused(
      [&] {
        write_hdr(here / "a", picture);
        return 0;
      },
      {"a: pixel", "inf"});
  CHECK(scratch::get(here / "a") == "old");
  check_refused(
      [&] {
        write_png(here / "absent" / "a", gradient(1, 1));
        return 0;
      },
      {"absent/a", "No such file"});
}

TEST_CASE("light probes are read") {
  for (const char* name : {"grace_probe_latlong.hdr", "studio_small_03_1k.hdr"}) {
    const scratch::fs::path path = scratch::fs::path(GONIO_SHARED_DATA) / "environment" / name;
    if (!scratch::fs::exists(path)) {
      MESSAGE("skipped: " << path.string() << " is not here");
      continue;
    }
    const image probe = read_hdr(path);
    CHECK(probe.shape(0) == 512);
    CHECK(probe.shape(1) == 1024);
    const auto [low, high] = std::minmax_element(probe.data(), probe.data() + probe.size());
    CHECK(*low >= 0.0f);
    CHECK(*high > 10.0f);
  }
}
