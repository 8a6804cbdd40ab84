#include "scratch.hpp"
#include "tiff_bytes.hpp"
#include <gonio/io/images/tiff.hpp>

#include <doctest/doctest.h>

#include <cstdint>

using gonio::io::read_tiff;
using gonio::io::read_tiff_exposure_time;
using scratch::check_refused;

TEST_CASE("TIFF: counts of 8 and 16 bits, of one channel and of three, are read") {
  tiff_bytes::image picture{.columns = 2, .rows = 2, .bits = 16, .channels = 3};
  picture.samples = {1, 2, 3, 400, 500, 600, 7, 8, 9, 65535, 0, 256};
  const auto codes = read_tiff(tiff_bytes::of(picture), "a.tif");
  CHECK(codes.columns == 2);
  CHECK(codes.rows == 2);
  CHECK(codes.largest == 65535);
  CHECK(codes.values == std::vector<std::uint16_t>{1, 2, 3, 400, 500, 600, 7, 8, 9, 65535, 0, 256});

  tiff_bytes::image grey{.columns = 3, .rows = 1, .bits = 8, .channels = 1, .meaning = 1};
  grey.samples = {0, 128, 255};
  const auto grey_codes = read_tiff(tiff_bytes::of(grey), "a.tif");
  CHECK(grey_codes.largest == 255);
  CHECK(grey_codes.values == std::vector<std::uint16_t>{0, 0, 0, 128, 128, 128, 255, 255, 255});

  // With one channel, separate planes make no difference.
  grey.more = {{284, 3, 1, 2}};
  CHECK(read_tiff(tiff_bytes::of(grey), "a.tif").values == grey_codes.values);

  // A fourth channel is ignored.
  tiff_bytes::image with_alpha{.columns = 1, .rows = 1, .bits = 8, .channels = 4};
  with_alpha.samples = {1, 2, 3, 4};
  CHECK(read_tiff(tiff_bytes::of(with_alpha), "a.tif").values == std::vector<std::uint16_t>{1, 2, 3});
}

TEST_CASE("TIFF: the exposure time is read from the EXIF data, if there is any") {
  tiff_bytes::image picture{.columns = 1, .rows = 1, .bits = 16, .channels = 3};
  picture.samples = {1, 2, 3};
  CHECK_FALSE(read_tiff_exposure_time(tiff_bytes::of(picture), "a.tif"));
  picture.exposure = {1, 250};
  CHECK(*read_tiff_exposure_time(tiff_bytes::of(picture), "a.tif") == doctest::Approx(0.004));
  CHECK(read_tiff(tiff_bytes::of(picture), "a.tif").values.size() == 3);
  for (const auto& absurd : {std::pair<std::uint32_t, std::uint32_t>{0, 1}, {1, 0}, {4000000000u, 1}}) {
    picture.exposure = absurd;
    check_refused([&] { return read_tiff_exposure_time(tiff_bytes::of(picture), "a.tif"); },
                  {"a.tif: an exposure time of", "expected from 1e-07 s to a day"});
  }
  check_refused([] { return read_tiff_exposure_time(scratch::bytes_of("no image"), "a.tif"); },
                {"a.tif", "not a TIFF"});
}

TEST_CASE("TIFF: unsupported images are refused; the error names the reason") {
  tiff_bytes::image good{.columns = 2, .rows = 1, .bits = 16, .channels = 3};
  good.samples = {1, 2, 3, 4, 5, 6};
  CHECK_NOTHROW(read_tiff(tiff_bytes::of(good), "a.tif"));
  const auto refused = [&](const auto& change, std::initializer_list<std::string> words) {
    tiff_bytes::image bad = good;
    change(bad);
    check_refused([&] { return read_tiff(tiff_bytes::of(bad), "a.tif"); }, words);
    check_refused([&] { return read_tiff(tiff_bytes::of(bad), "a.tif"); }, {"a.tif: "});
  };
  refused([](auto& p) { p.bits = 1; }, {"has 1 bits a sample, expected 8 or 16"});
  refused([](auto& p) { p.bits = 32; }, {"has 32 bits a sample"});
  refused([](auto& p) { p.more = {{339, 3, 1, 3}}; }, {"not unsigned integers"});
  refused([](auto& p) { p.more = {{284, 3, 1, 2}}; }, {"planar channels"});
  refused([](auto& p) { p.meaning = 5; }, {"neither RGB nor grey", "is 5"});
  refused([](auto& p) { p.compression = 34712; }, {"compression", "34712"});
  refused([](auto& p) { p.columns = 40000; }, {"40000 x 1 pixels, expected from 1 to 16384 each way"});
  refused([](auto& p) { p.columns = p.rows = 16000; }, {"16000 x 16000 pixels cannot fit in"});
  refused([](auto& p) { p.rows = 0; }, {"a.tif"});
  refused([](auto& p) { p.samples.resize(5); }, {"is damaged", "StripByteCounts"});
  // Tiles of 16 x 16: TileWidth, TileLength.
  refused([](auto& p) { p.more = {{322, 3, 1, 16}, {323, 3, 1, 16}, {324, 4, 1, 8}, {325, 4, 1, 12}}; }, {"is tiled"});
}

TEST_CASE("TIFF: truncated and damaged files are read or refused") {
  tiff_bytes::image picture{.columns = 5, .rows = 4, .bits = 16, .channels = 3};
  picture.samples.assign(60, 77);
  picture.exposure = {1, 60};
  const std::vector<std::byte> whole = tiff_bytes::of(picture);
  // The last four bytes state that there is no other image.
  for (std::size_t size = 0; size < whole.size(); ++size) {
    if (size + 4 < whole.size()) CHECK_THROWS_AS(read_tiff(std::span(whole).first(size), "a.tif"), gonio::error);
    try {
      static_cast<void>(read_tiff_exposure_time(std::span(whole).first(size), "a.tif"));
    } catch (const gonio::error&) {
    }
  }
  scratch::check_survives_damage(whole, 2000, [](std::span<const std::byte> bytes) {
    return read_tiff(bytes, "damaged.tif").values.size() + read_tiff_exposure_time(bytes, "damaged.tif").has_value();
  });
  const scratch::folder here;
  scratch::check_refuses_non_files([](const auto& path) { return gonio::io::read_tiff(path); });
}
