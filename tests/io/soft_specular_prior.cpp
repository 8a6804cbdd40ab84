#include "../synthetic_materials.hpp"
#include "scratch.hpp"
#include <gonio/estimate/soft_specular_decomposition.hpp>
#include <gonio/io/bytes/byte_stream.hpp>
#include <gonio/io/bytes/checked_file.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/materials/soft_specular_prior.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <random>

namespace io = gonio::io;

namespace {

gonio::soft_specular_prior small_split(unsigned seed = 7) {
  const auto set = synthetic_materials(gonio::valid_cells(gonio::grid({18, 9, 12})), 7, seed);
  return gonio::learn_soft_specular_prior(set, gonio::log_relative::to_median_of(set), 5).with_source("seven");
}

std::string refusal(std::span<const std::byte> bytes) {
  try {
    static_cast<void>(io::read_soft_specular_prior(bytes, "x.prior"));
  } catch (const gonio::error& error) {
    return error.what();
  }
  return "";
}

/// The payload of a plain prior.
std::vector<std::byte> payload_of(const gonio::log_relative_pca& prior) {
  return io::read_checked({"gonio-pca", 1, "prior"}, io::write_prior(prior), "x");
}

/// A file of a threshold and two payloads with a right checksum; `lie` is added to the first length.
std::vector<std::byte> file_of(double threshold, std::span<const std::byte> soft, std::span<const std::byte> specular,
                               std::uint64_t lie = 0, std::size_t trailing = 0) {
  io::byte_writer out;
  out.write(threshold);
  for (const auto& half : {soft, specular}) {
    out.write(std::uint64_t{half.size()} + (half.data() == soft.data() ? lie : 0));
    out.write_bytes(half.data(), half.size());
  }
  for (std::size_t i = 0; i < trailing; ++i) out.write('x');
  return io::write_checked({"gonio-split", 1, "soft and specular prior"}, out.bytes());
}

}  // namespace

TEST_CASE("two priors are read back as from separate files, and the threshold exactly") {
  const auto prior = small_split();
  const auto back = io::read_soft_specular_prior(io::write_soft_specular_prior(prior), "x");
  CHECK(back.threshold() == prior.threshold());
  const auto same = [](const gonio::log_relative_pca& read, const gonio::log_relative_pca& written) {
    const auto alone = io::read_prior(io::write_prior(written), "x");
    CHECK(read.names() == written.names());
    CHECK(read.source() == "seven");
    CHECK(read.components() == alone.components());
    CHECK(read.mean() == alone.mean());
    CHECK(read.coefficients() == written.coefficients());
    CHECK(std::ranges::equal(read.metric().reference(), alone.metric().reference()));
  };
  same(back.soft(), prior.soft());
  same(back.specular(), prior.specular());
  CHECK(io::write_soft_specular_prior(prior) ==
        file_of(prior.threshold(), payload_of(prior.soft()), payload_of(prior.specular())));
}

TEST_CASE("damaged files of two priors are refused; the error names the fault") {
  const auto whole = io::write_soft_specular_prior(small_split());
  CHECK(refusal({}).find("not a gonio soft and specular prior") != std::string::npos);
  for (const std::size_t length :
       {std::size_t{5}, std::size_t{12}, std::size_t{20}, whole.size() / 2, whole.size() - 1})
    CHECK(refusal(std::span(whole).first(length)).starts_with("x.prior: "));
  auto longer = whole;
  longer.push_back(std::byte{0});
  CHECK(refusal(longer) != "");
  auto version = whole;
  version[11] = std::byte{77};
  CHECK(refusal(version).find("version 77") != std::string::npos);
  std::mt19937 generator(3);
  int noticed = 0;
  for (int i = 0; i < 60; ++i) {
    auto damaged = whole;
    damaged[generator() % damaged.size()] ^= static_cast<std::byte>(1 + generator() % 255);
    noticed += refusal(damaged).empty() ? 0 : 1;
  }
  CHECK(noticed >= 59);  // the last bits of a deflated stream are not read
}

TEST_CASE("two impossible priors with a correct checksum are refused") {
  const auto prior = small_split();
  const auto soft = payload_of(prior.soft()), specular = payload_of(prior.specular());
  CHECK(refusal(file_of(0.5, soft, specular)).empty());
  CHECK(refusal(file_of(std::numeric_limits<double>::quiet_NaN(), soft, specular)) ==
        "x.prior: the contrast threshold between soft and specular materials must be finite");
  CHECK(refusal(file_of(0.5, soft, specular, 0, 3)) == "x.prior: 3 bytes follow the specular prior");
  CHECK(refusal(file_of(0.5, soft, specular, 1)).starts_with("x.prior: "));
  CHECK(refusal(file_of(0.5, soft, specular, ~std::uint64_t{0} - soft.size())).find("truncated") != std::string::npos);
  CHECK(refusal(file_of(0.5, {}, specular)).find("truncated") != std::string::npos);
  const auto other = payload_of(small_split(8).specular());
  CHECK(refusal(file_of(0.5, soft, other)).find("x.prior: the soft and the specular prior must be") !=
        std::string::npos);
}

TEST_CASE("files of one and of two priors are distinguished") {
  const scratch::folder folder;
  const auto two = folder / "two.prior", one = folder / "one.prior";
  io::write_soft_specular_prior(two, small_split());
  io::write_prior(one, small_split().soft());
  CHECK(io::is_soft_specular_prior(two));
  CHECK_FALSE(io::is_prior(two));
  CHECK_FALSE(io::is_soft_specular_prior(one));
  CHECK(io::read_soft_specular_prior(two).materials() == 7);
  CHECK_THROWS_WITH_AS((void)io::read_prior(two),
                       doctest::Contains("two.prior: has a soft and a specular prior, expected one"), gonio::error);
  CHECK_THROWS_WITH_AS((void)io::read_soft_specular_prior(one),
                       doctest::Contains("it does not start with 'gonio-split'"), gonio::error);
  CHECK_THROWS_WITH_AS((void)io::read_soft_specular_prior(folder / "none.prior"), doctest::Contains("none.prior"),
                       gonio::error);
}
