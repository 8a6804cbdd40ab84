#include "../synthetic_materials.hpp"
#include <gonio/io/bytes/gzip.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/materials/prior_payload.hpp>

#include <doctest/doctest.h>

#include <span>
#include <string>
#include <vector>

namespace io = gonio::io;

namespace {

gonio::log_relative_pca small_prior() {
  return learn(synthetic_materials(gonio::valid_cells(gonio::grid({18, 9, 12})), 5), 8);
}

std::vector<std::byte> payload_of(const gonio::log_relative_pca& prior) {
  io::byte_writer out;
  io::write_prior(out, prior);
  return std::move(out).bytes();
}

}  // namespace

TEST_CASE("the payload of a prior's file is its bytes after the first 25, inflated") {
  const auto prior = small_prior();
  const auto payload = payload_of(prior), file = io::write_prior(prior);
  CHECK(io::decompress_bytes(std::span(file).subspan(25), payload.size(), "x") == payload);
  io::byte_reader in(payload, "x");
  const auto back = io::read_prior(in, "x"), read = io::read_prior(file, "x");
  CHECK(back.components() == read.components());
  CHECK(back.mean() == read.mean());
  CHECK(back.names() == read.names());
}

TEST_CASE("a payload that is too short or too long is refused") {
  auto payload = payload_of(small_prior());
  const auto refusal = [](std::span<const std::byte> bytes) -> std::string {
    io::byte_reader in(bytes, "a page");
    try {
      static_cast<void>(io::read_prior(in, "a page"));
    } catch (const gonio::error& error) {
      return error.what();
    }
    return "";
  };
  CHECK(refusal(payload) == "");
  CHECK(refusal(std::span(payload).first(payload.size() - 1)).starts_with("a page: the file is truncated"));
  CHECK(refusal({}).starts_with("a page"));
  payload.push_back({});
  CHECK(refusal(payload) == "a page: 1 bytes follow the last component");
}
