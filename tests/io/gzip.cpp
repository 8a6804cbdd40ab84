#include "scratch.hpp"
#include <gonio/io/bytes/gzip.hpp>

#include <rapidcheck.h>

using gonio::io::compress_bytes;
using gonio::io::decompress_bytes;
using gonio::io::gunzip;
using gonio::io::gunzip_prefix;
using gonio::io::is_gzip;
using scratch::bytes_of;
using scratch::check_refused;

namespace {

constexpr std::size_t plenty = 1 << 20;

std::vector<std::byte> gzipped(const std::vector<std::byte>& bytes) {
  z_stream stream{};
  REQUIRE(deflateInit2(&stream, 6, Z_DEFLATED, MAX_WBITS + 16, 8, Z_DEFAULT_STRATEGY) == Z_OK);
  std::vector<std::byte> result(deflateBound(&stream, static_cast<uLong>(bytes.size())));
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  stream.avail_out = static_cast<uInt>(result.size());
  REQUIRE(deflate(&stream, Z_FINISH) == Z_STREAM_END);
  result.resize(stream.total_out);
  deflateEnd(&stream);
  return result;
}

std::vector<std::byte> joined(std::vector<std::byte> a, const std::vector<std::byte>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::vector<std::byte> sample_bytes() {
  std::string text;
  for (int i = 0; i < 300; ++i) text += std::to_string(i * i) + ',';
  return bytes_of(text);
}

}  // namespace

TEST_CASE("gunzip inverts gzip") {
  CHECK(rc::check("gunzip inverts gzip", [](const std::vector<unsigned char>& content) {
    const auto raw = std::as_bytes(std::span(content));
    const std::vector<std::byte> bytes(raw.begin(), raw.end());
    RC_ASSERT(is_gzip(gzipped(bytes)));
    RC_ASSERT(gunzip(gzipped(bytes), bytes.size(), "x") == bytes);
    RC_ASSERT(gunzip(gzipped(bytes), plenty, "x") == bytes);
  }));
  const std::vector<std::byte> zeros(plenty);
  CHECK(gunzip(gzipped(zeros), std::numeric_limits<std::size_t>::max(), "x") == zeros);
}

TEST_CASE("members are joined") {
  const auto one = bytes_of("one,"), two = sample_bytes(), nothing = bytes_of("");
  const auto file = joined(joined(gzipped(two), gzipped(nothing)), gzipped(one));
  CHECK(gunzip(file, plenty, "x") == joined(two, one));
  CHECK(gunzip(file, two.size() + one.size(), "x") == joined(two, one));
}

TEST_CASE("a prefix is expanded alone") {
  const auto bytes = sample_bytes();
  CHECK(gunzip_prefix(gzipped(bytes), 12, "x") == std::vector<std::byte>(bytes.begin(), bytes.begin() + 12));
  CHECK(gunzip_prefix(gzipped(bytes_of("short")), 12, "x") == bytes_of("short"));
  check_refused([] { return gunzip_prefix(bytes_of("plain"), 12, "a.gz"); }, {"a.gz", "not gzip"});
}

TEST_CASE("damaged gzip data is refused") {
  const auto bytes = sample_bytes();
  const auto valid = gzipped(bytes);
  for (std::size_t size = 0; size < valid.size(); ++size) {
    const std::vector<std::byte> part(valid.begin(), valid.begin() + static_cast<std::ptrdiff_t>(size));
    check_refused([&] { return gunzip(part, plenty, "a.gz"); }, {"a.gz: ", size < 2 ? "not gzip" : "truncated"});
  }
  for (const std::size_t from_end : {1u, 5u, 20u}) {
    auto corrupt = valid;
    corrupt[corrupt.size() - from_end] ^= std::byte{0x10};
    check_refused([&] { return gunzip(corrupt, plenty, "a.gz"); }, {"a.gz: ", "corrupt"});
  }
  check_refused([&] { return gunzip(joined(valid, bytes_of("rest")), plenty, "a.gz"); }, {"a.gz: ", "4 bytes follow"});
  check_refused([&] { return gunzip(joined(valid, std::vector<std::byte>(3)), plenty, "a.gz"); }, {"3 bytes follow"});
  check_refused([&] { return gunzip(valid, bytes.size() - 1, "a.gz"); },
                {"a.gz: ", "more than the expected " + std::to_string(bytes.size() - 1)});
  check_refused([&] { return gunzip(valid, 0, "a.gz"); }, {"more than the expected 0"});
  check_refused([&] { return gunzip(bytes_of("plain text"), plenty, "a.gz"); }, {"a.gz: ", "not gzip"});
  check_refused([&] { return gunzip({}, plenty, "a.gz"); }, {"a.gz: ", "not gzip"});
  scratch::check_survives_damage(valid, 2000, [](auto damaged) { return gunzip(damaged, plenty, "x"); });
}

TEST_CASE("a claimed size is not believed") {
  auto valid = gzipped(bytes_of("few"));
  for (std::size_t i = valid.size() - 4; i < valid.size(); ++i) valid[i] = std::byte{0xFF};
  check_refused([&] { return gunzip(valid, std::numeric_limits<std::size_t>::max(), "a.gz"); }, {"a.gz", "corrupt"});
}

TEST_CASE("decompress inverts compress") {
  CHECK(rc::check("decompress inverts compress", [](const std::vector<unsigned char>& content) {
    const auto raw = std::as_bytes(std::span(content));
    const std::vector<std::byte> bytes(raw.begin(), raw.end());
    RC_ASSERT(decompress_bytes(compress_bytes(bytes), bytes.size(), "x") == bytes);
    RC_ASSERT(decompress_bytes(compress_bytes(bytes, 1), bytes.size(), "x") == bytes);
  }));
  const std::vector<std::byte> zeros(10 * plenty);
  CHECK(decompress_bytes(compress_bytes(zeros), zeros.size(), "x") == zeros);
}

TEST_CASE("damaged zlib data is refused") {
  const auto bytes = sample_bytes();
  const auto valid = compress_bytes(bytes);
  for (std::size_t size = 0; size < valid.size(); ++size)
    check_refused([&] { return decompress_bytes(std::span(valid).first(size), bytes.size(), "a"); },
                  {"a: ", "truncated"});
  check_refused([&] { return decompress_bytes(valid, bytes.size() + 1, "a"); },
                {"a: expands to " + std::to_string(bytes.size()), "expected " + std::to_string(bytes.size() + 1)});
  check_refused([&] { return decompress_bytes(valid, bytes.size() - 1, "a"); }, {"a: ", "expands to more than"});
  check_refused([&] { return decompress_bytes(valid, 0, "a"); }, {"a: ", "expands to more than"});
  check_refused([&] { return decompress_bytes(joined(valid, bytes_of("x")), bytes.size(), "a"); }, {"1 bytes follow"});
  check_refused([&] { return decompress_bytes(valid, std::size_t{1} << 50, "a"); },
                {"a: ", "cannot hold the expected"});
  auto corrupt = valid;
  corrupt.back() ^= std::byte{1};
  check_refused([&] { return decompress_bytes(corrupt, bytes.size(), "a"); }, {"a: ", "corrupt"});
  scratch::check_survives_damage(valid, 2000,
                                 [&](auto damaged) { return decompress_bytes(damaged, bytes.size(), "x"); });
}
