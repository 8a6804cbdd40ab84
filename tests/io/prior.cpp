#include "../synthetic_materials.hpp"
#include "scratch.hpp"
#include <gonio/basis/learn_streamed_pca.hpp>
#include <gonio/io/bytes/byte_stream.hpp>
#include <gonio/io/bytes/checked_file.hpp>
#include <gonio/io/bytes/quantise.hpp>
#include <gonio/io/materials/prior.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <random>

namespace io = gonio::io;

namespace {

gonio::log_relative_pca small_prior() {
  return learn(synthetic_materials(gonio::valid_cells(gonio::grid({18, 9, 12})), 5), 8)
      .with_source("five synthetic materials");
}

std::string refusal(std::span<const std::byte> bytes) {
  try {
    static_cast<void>(io::read_prior(bytes, "x.prior"));
  } catch (const gonio::error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a prior is read back with only the errors of quantisation") {
  const auto prior = small_prior(), back = io::read_prior(io::write_prior(prior), "x");
  CHECK(back.cells() == prior.cells());
  CHECK(back.names() == prior.names());
  CHECK(back.source() == prior.source());
  CHECK(back.explained_variance() == prior.explained_variance());
  CHECK(back.singular_values() == prior.singular_values());
  CHECK(back.coefficients() == prior.coefficients());
  for (Eigen::Index k = 0; k < prior.components().cols(); ++k) {
    const auto column = prior.components().col(k);
    const float half_step = 0.5f * (column.maxCoeff() - column.minCoeff()) / 255.0f;
    CHECK((back.components().col(k) - column).cwiseAbs().maxCoeff() <= 1.001f * half_step);
  }
  for (Eigen::Index cell = 0; cell < prior.cells().size(); ++cell) {
    REQUIRE(back.offset(cell) == doctest::Approx(prior.offset(cell)).epsilon(1e-3));
    REQUIRE(back.metric().reference()[cell] == doctest::Approx(prior.metric().reference()[cell]).epsilon(1e-3));
  }
}

TEST_CASE("a prior keeps the cosine weighting of its metric; the product is the default") {
  const auto set = synthetic_materials(gonio::valid_cells(gonio::grid({18, 9, 12})), 5);
  const auto metric = gonio::log_relative::to_median_of(set);
  const auto written = [&](gonio::cosine_weighting weighting) {
    return io::write_prior(gonio::learn_pca(set, metric.weighted_by(weighting), 8));
  };
  const auto product = written(gonio::cosine_weighting::product), larger = written(gonio::cosine_weighting::larger);
  CHECK(product == io::write_prior(gonio::learn_pca(set, metric, 8)));
  CHECK(io::read_prior(product, "x").metric().weighting() == gonio::cosine_weighting::product);
  const auto back = io::read_prior(larger, "x");
  CHECK(back.metric().weighting() == gonio::cosine_weighting::larger);
  const auto at = gonio::locate(back.cells(), {0.3, 0.4, 0.5});
  CHECK(back.metric().cosine_weight(at.cosine) == std::max(at.cosine.i, at.cosine.o));
}

TEST_CASE("wavelengths are read back; older programs refuse such files by their version, but read priors in RGB") {
  const std::vector<double> wavelengths{405.0, 532.0, 633.0, 780.0, 1064.0};
  const auto set = synthetic_materials(gonio::valid_cells(gonio::grid({18, 9, 12})), 5);
  const auto prior = gonio::learn_streamed_pca(at_wavelengths(set, wavelengths), {.components = 8}).prior;
  const auto bytes = io::write_prior(prior), colours = io::write_prior(learn(set, 8));
  CHECK(bytes[9] == std::byte{2});
  CHECK(colours[9] == std::byte{1});
  const auto back = io::read_prior(bytes, "x");
  CHECK(back.wavelengths() == wavelengths);
  CHECK(back.channels() == 5);
  CHECK(back.names() == prior.names());
  CHECK(back.coefficients() == prior.coefficients());
  CHECK(io::read_prior(colours, "x").wavelengths().empty());
  try {
    static_cast<void>(io::read_checked({"gonio-pca", 1, "prior"}, bytes, "x.prior"));  // as older programs do
    FAIL("an older program reads it");
  } catch (const gonio::error& refusal) {
    CHECK(std::string(refusal.what()) == "x.prior: prior format version 2, this program reads version 1");
  }
}

TEST_CASE("impossible wavelengths are refused") {
  const auto refusal_of = [](std::uint32_t count, double second) {
    io::byte_writer payload;
    for (int axis = 0; axis < 3; ++axis) payload.write(std::uint32_t{4});
    payload.write(std::uint32_t{4});  // wavelengths
    payload.write(0.0);
    payload.write(std::uint32_t{1});  // one component of one material
    payload.write(std::uint32_t{1});
    payload.write(count);
    payload.write(500.0);
    payload.write(second);
    for (int i = 0; i < 1000; ++i) payload.write(std::uint64_t{0});
    return refusal(io::write_checked({"gonio-pca", 2, "prior"}, payload.bytes()));
  };
  CHECK(refusal_of(0, 600.0).find("cannot hold 0 wavelengths") != std::string::npos);
  CHECK(refusal_of(0xffffffff, 600.0).find("cannot hold 4294967295 wavelengths") != std::string::npos);
  CHECK(refusal_of(2, 600.0).find("follow the last component") != std::string::npos);
  CHECK(refusal_of(2, 400.0).find("wavelength 2 of a spectrum is not above") != std::string::npos);
  CHECK(refusal_of(2, std::nan("")).find("wavelength 2 of a spectrum is not above") != std::string::npos);
}

TEST_CASE("a prior that is read and written again keeps its codes") {
  const auto once = io::write_prior(small_prior());
  const auto back = io::read_prior(once, "x");
  const auto twice = io::write_prior(back);
  // The codes are the same; only the exponential and logarithm of the reference may round.
  CHECK(io::read_prior(twice, "x").components() == back.components());
  CHECK(io::read_prior(twice, "x").mean() == back.mean());
}

TEST_CASE("a quantised column keeps constants and extremes") {
  const std::vector<float> constant(5, 3.5f), two{-1.0f, 7.0f};
  const auto flat = io::quantise<std::uint8_t>(std::span<const float>(constant));
  CHECK(io::dequantise(flat, 3) == 3.5f);
  const auto span = io::quantise<std::uint16_t>(std::span<const float>(two));
  CHECK(io::dequantise(span, 0) == -1.0f);
  CHECK(io::dequantise(span, 1) == doctest::Approx(7.0f));
  io::byte_writer out;
  io::write_quantised(out, span);
  io::byte_reader in(out.bytes(), "x");
  CHECK(io::read_quantised<std::uint16_t>(in, 2).codes == span.codes);
  CHECK(in.left() == 0);
}

TEST_CASE("damaged priors are refused; the error names the fault") {
  const auto whole = io::write_prior(small_prior());
  CHECK(refusal({}).find("not a gonio prior") != std::string::npos);
  CHECK(refusal(std::span(whole).first(5)).find("not a gonio prior") != std::string::npos);
  for (const std::size_t length :
       {std::size_t{9}, std::size_t{12}, std::size_t{20}, std::size_t{30}, whole.size() / 2, whole.size() - 1}) {
    CAPTURE(length);
    CHECK(refusal(std::span(whole).first(length)).find("x.prior") != std::string::npos);
  }
  auto longer = whole;
  longer.push_back(std::byte{0});
  CHECK(refusal(longer) != "");
  auto version = whole;
  version[9] = std::byte{77};
  CHECK(refusal(version) == "x.prior: prior format version 77, this program reads versions 1 to 2");
  auto size = whole;
  size[13 + 7] = std::byte{0xff};
  CHECK(refusal(size).find("cannot fit in") != std::string::npos);
}

TEST_CASE("a flipped byte is detected, or is padding of the compressed stream") {
  const auto whole = io::write_prior(small_prior());
  std::mt19937 generator(3);
  int noticed = 0;
  for (int i = 0; i < 200; ++i) {
    auto damaged = whole;
    const std::size_t position = generator() % damaged.size();
    damaged[position] ^= static_cast<std::byte>(1 + generator() % 255);
    CAPTURE(position);
    // The last bits of a deflated stream are not read: a prior that is not refused is the one that was written.
    if (refusal(damaged).empty())
      CHECK(io::write_prior(io::read_prior(damaged, "x")) == io::write_prior(io::read_prior(whole, "x")));
    else
      ++noticed;
  }
  CHECK(noticed >= 198);
}

TEST_CASE("impossible contents with a correct checksum are refused") {
  // A prior over a grid with a wrong count, as a buggy writer might make it.
  const auto written = [](auto&& fill) {
    io::byte_writer payload;
    fill(payload);
    return io::write_checked(io::checked_file_kind{"gonio-pca", 1, "prior"}, payload.bytes());
  };
  const auto header = [](io::byte_writer& out, std::uint32_t extent, std::uint32_t anchor, std::uint32_t components,
                         int padding = 100) {
    for (int axis = 0; axis < 3; ++axis) out.write(extent);
    out.write(anchor);
    out.write(0.0);
    out.write(components);
    out.write(std::uint32_t{2});
    out.write(1.0);
    for (int i = 0; i < padding; ++i) out.write(std::uint64_t{0});
  };
  CHECK(refusal(written([&](auto& out) { header(out, 0, 0, 3); })).find("extent") != std::string::npos);
  CHECK(refusal(written([&](auto& out) { header(out, 0xffffffff, 0, 3); })).find("extent") != std::string::npos);
  CHECK(refusal(written([&](auto& out) { header(out, 4000, 0, 3); })).find("more cells") != std::string::npos);
  CHECK(refusal(written([&](auto& out) { header(out, 4, 9, 3); })).find("wavelengths are 9, expected 0 to 7") !=
        std::string::npos);
  CHECK(refusal(written([&](auto& out) { header(out, 4, 0, 0); })).find("0 components of 2 materials, expected") !=
        std::string::npos);
  CHECK(refusal(written([&](auto& out) { header(out, 4, 0, 700); })).find("700 components of 2 materials, expected") !=
        std::string::npos);
  CHECK(refusal(written([&](auto& out) { header(out, 4, 0, 3, 30); })).find("truncated") != std::string::npos);
  CHECK(refusal(written([&](auto& out) { header(out, 4, 0, 3, 1000); })).find("bytes follow") != std::string::npos);
  for (const std::uint32_t extent : {0u, 4u, 0xffffffffu})
    CHECK(refusal(written([&](auto& out) { header(out, extent, 0, 3); })).starts_with("x.prior: "));
}

TEST_CASE("files of priors are written, recognised and read back; unreadable ones are refused") {
  const scratch::folder folder;
  const auto path = folder / "small.prior";
  io::write_prior(path, small_prior());
  CHECK(io::is_prior(path));
  CHECK(io::read_prior(path).size() == 8);
  CHECK_FALSE(io::is_prior(folder / "missing.prior"));
  CHECK_THROWS_WITH_AS(static_cast<void>(io::read_prior(folder / "missing.prior")), doctest::Contains("missing.prior"),
                       gonio::error);
  CHECK_THROWS_AS(static_cast<void>(io::read_prior(folder.path())), gonio::error);
  CHECK_THROWS_AS(io::write_prior(folder / "no-such-folder" / "x.prior", small_prior()), gonio::error);
}

TEST_CASE("the shipped prior is read") {
  const auto prior = io::read_prior(std::string(GONIO_SOURCE_DIR) + "/examples/data/materials.prior");
  CHECK(prior.size() == 100);
  CHECK(prior.names().size() == 137);
  CHECK(prior.explained_variance() > 0.9995);
}
