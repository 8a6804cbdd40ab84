#include "scratch.hpp"
#include <gonio/io/bytes/checked_file.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace io = gonio::io;

namespace {

constexpr io::checked_file_kind recipe_kind{"gonio-recipe", 3, "recipe"};
constexpr std::size_t recipe_version_at = recipe_kind.magic.size(), recipe_size_at = recipe_version_at + 4,
                      recipe_checksum_at = recipe_size_at + 8, recipe_data_at = recipe_checksum_at + 4;

std::vector<std::byte> recipe() { return io::write_checked(recipe_kind, scratch::bytes_of("flour, water, and salt")); }

void check_recipe_refused(std::span<const std::byte> bytes, const std::string& words) {
  scratch::check_refused([&] { return io::read_checked(recipe_kind, bytes, "bread.recipe"); },
                         {"bread.recipe: ", words});
}

}  // namespace

TEST_CASE("checked file: any payload is read back, even an empty one") {
  CHECK(rc::check([](const std::vector<std::uint8_t>& payload) {
    const auto bytes = std::as_bytes(std::span(payload));
    const auto back = io::read_checked(recipe_kind, io::write_checked(recipe_kind, bytes), "x");
    RC_ASSERT(std::ranges::equal(back, bytes));
  }));
  CHECK(io::read_checked(recipe_kind, io::write_checked(recipe_kind, {}), "x").empty());
}

TEST_CASE("checked file: the layout is the documented one") {
  const auto file = recipe();
  io::byte_reader in(file, "x");
  CHECK(std::ranges::equal(in.read_bytes(recipe_kind.magic.size()), scratch::bytes_of("gonio-recipe")));
  CHECK(in.read<std::uint32_t>() == 3);
  CHECK(in.read<std::uint64_t>() == 22);
  CHECK(in.read<std::uint32_t>() == io::checksum(scratch::bytes_of("flour, water, and salt")));
  CHECK(in.read<std::uint8_t>() == 0x78);  // a zlib stream of the usual window
  // CRC-32's check value.
  CHECK(io::checksum(scratch::bytes_of("123456789")) == 0xcbf43926u);
}

TEST_CASE("checked file: another kind and an empty file are refused") {
  const std::string other = "not a gonio recipe (it does not start with 'gonio-recipe')";
  check_recipe_refused({}, other);
  check_recipe_refused(scratch::bytes_of("gonio-recip"), other);
  check_recipe_refused(io::write_checked({"gonio-sketch", 3, "sketch"}, {}), other);
}

TEST_CASE("checked file: another version is refused") {
  auto file = recipe();
  file[recipe_version_at] = std::byte{4};
  check_recipe_refused(file, "recipe format version 4, this program reads version 3");
}

TEST_CASE("checked file: implausible and false sizes are refused") {
  auto file = recipe();
  file[recipe_size_at + 7] = std::byte{1};
  check_recipe_refused(file, "a recipe of 72057594037927958 bytes cannot fit in");
  for (const std::uint8_t size : {std::uint8_t{0}, std::uint8_t{21}, std::uint8_t{23}}) {
    CAPTURE(size);
    file = recipe();
    file[recipe_size_at] = std::byte{size};
    check_recipe_refused(file, "expands to ");
  }
  // Believable, but the data is too short: refused before memory is allocated.
  file = recipe();
  file[recipe_size_at + 2] = std::byte{0x20};
  check_recipe_refused(file, "truncated");
}

TEST_CASE("checked file: a payload is read back even if deflate shrinks it implausibly") {
  std::vector<std::byte> payload(std::size_t{20} << 20);
  payload[7'000'000] = std::byte{9};
  const auto file = io::write_checked(recipe_kind, payload);
  CHECK(file.size() > payload.size() / 9);
  CHECK(io::read_checked(recipe_kind, file, "x") == payload);
  payload.resize(std::size_t{8} << 20);
  CHECK(io::write_checked(recipe_kind, payload).size() < 10'000);
}

TEST_CASE("checked file: a wrong checksum is refused") {
  auto file = recipe();
  file[recipe_checksum_at] ^= std::byte{1};
  check_recipe_refused(file, "the checksum does not match, the file is damaged");
}

TEST_CASE("checked file: a truncated or longer file is refused") {
  const auto whole = recipe();
  for (std::size_t length = 0; length < whole.size(); ++length) {
    CAPTURE(length);
    check_recipe_refused(std::span(whole).first(length), "");
  }
  auto longer = whole;
  longer.push_back(std::byte{0});
  check_recipe_refused(longer, "1 bytes follow");
}

TEST_CASE("checked file: a flipped bit is refused unless deflate does not use it") {
  const auto whole = recipe(), payload = scratch::bytes_of("flour, water, and salt");
  std::size_t unused = 0;
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    auto damaged = whole;
    damaged[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
    CAPTURE(bit);
    try {
      const auto back = io::read_checked(recipe_kind, damaged, "bread.recipe");
      CHECK(back == payload);
      CHECK(bit / 8 >= recipe_data_at);
      ++unused;
    } catch (const gonio::error& refusal) {
      CHECK(std::string(refusal.what()).starts_with("bread.recipe: "));
    }
  }
  CHECK(unused < 8);  // the last block ends within a byte, and zlib's checksum begins at the next
}

TEST_CASE("checked file: a file's kind is recognised by its first bytes") {
  const scratch::folder here;
  scratch::put(here / "bread.recipe", recipe());
  scratch::put(here / "start", std::string("gonio-recipe"));
  scratch::put(here / "short", std::string("gonio-recip"));
  scratch::put(here / "other", std::string("gonio-sketch, and more"));
  scratch::put(here / "empty", std::string());
  CHECK(io::is_of_kind(recipe_kind, here / "bread.recipe"));
  CHECK(io::is_of_kind(recipe_kind, here / "start"));
  for (const std::string name : {"short", "other", "empty", "missing"}) {
    CAPTURE(name);
    CHECK_FALSE(io::is_of_kind(recipe_kind, here / name));
  }
  CHECK_FALSE(io::is_of_kind(recipe_kind, here.path()));
}
