#include "scratch.hpp"
#include "tiff_bytes.hpp"
#include <gonio/io/images/exif.hpp>

#include <doctest/doctest.h>

#include <cstdint>
#include <utility>

using gonio::io::read_exif_exposure_time;
using scratch::check_refused;

TEST_CASE("EXIF: the exposure time of a JPEG file is read") {
  CHECK(*read_exif_exposure_time(tiff_bytes::jpeg_of({{1, 250}}), "a.jpg") == doctest::Approx(0.004));
  CHECK(*read_exif_exposure_time(tiff_bytes::jpeg_of({{30, 1}}), "a.jpg") == doctest::Approx(30.0));
  CHECK_FALSE(read_exif_exposure_time(tiff_bytes::jpeg_of({}), "a.jpg"));
}

TEST_CASE("EXIF: implausible times and bad files are refused") {
  for (const auto& absurd : {std::pair<std::uint32_t, std::uint32_t>{0, 1}, {1, 0}, {0, 0}, {4000000000u, 1}})
    check_refused([&] { return read_exif_exposure_time(tiff_bytes::jpeg_of(absurd), "a.jpg"); },
                  {"a.jpg: an exposure time of", "expected from 1e-07 s to a day"});
  check_refused([] { return read_exif_exposure_time(scratch::bytes_of("no image"), "a.jpg"); },
                {"a.jpg", "not a JPEG"});
  check_refused([] { return read_exif_exposure_time({}, "a.jpg"); }, {"a.jpg", "not a JPEG"});
  check_refused([] { return read_exif_exposure_time(scratch::bytes_of("\xFF\xD8\xFF\xD9"), "a.jpg"); },
                {"a.jpg: has no EXIF data"});
  const std::vector<std::byte> whole = tiff_bytes::jpeg_of({{1, 250}});
  for (std::size_t size = 0; size < whole.size(); ++size) try {
      static_cast<void>(read_exif_exposure_time(std::span(whole).first(size), "a.jpg"));
    } catch (const gonio::error&) {
    }
  scratch::check_survives_damage(whole, 2000, [](std::span<const std::byte> bytes) {
    return read_exif_exposure_time(bytes, "damaged.jpg").has_value();
  });
}
