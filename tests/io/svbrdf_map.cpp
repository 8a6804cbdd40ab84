#include "../synthetic_materials.hpp"
#include "scratch.hpp"
#include <gonio/io/materials/svbrdf_map.hpp>

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <limits>
#include <random>

namespace io = gonio::io;
using io::svbrdf_map;
using io::svbrdf_writer;

namespace {

io::svbrdf_header header_of(Eigen::Index rows, Eigen::Index columns, Eigen::Index band_rows) {
  const auto at = [](double theta, double phi) { return gonio::spherical_direction(theta, phi); };
  return {.rows = rows,
          .columns = columns,
          .band_rows = band_rows,
          .eta = 2.5,
          .prior_checksum = 77,
          .prior_source = "tests",
          .directions = {{at(0.2, 0.0), at(0.4, 3.0)}, {at(0.9, 0.0), at(0.9, 3.0)}},
          .functions = Eigen::MatrixXf::Identity(6, 4)};
}

gonio::texel_estimates estimates(Eigen::Index texels, Eigen::Index components, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<float> number;
  const auto any = [&] { return number(generator); };
  return {Eigen::MatrixXf::NullaryExpr(components, 3 * texels, any), Eigen::ArrayXf::NullaryExpr(texels, any).abs(),
          Eigen::ArrayXf::NullaryExpr(texels, any).abs()};
}

io::svbrdf_band band_of(const io::svbrdf_header& header, Eigen::Index band) {
  return io::as_halves(estimates(header.texels_of_band(band), header.functions.cols(), static_cast<unsigned>(band)),
                       {1});
}

/// Writes bands up to number `until`; commits if these are all.
void write_bands(const scratch::fs::path& path, const io::svbrdf_header& header, Eigen::Index until) {
  svbrdf_writer writer(path, header);
  while (writer.finished() < until) writer.append(band_of(header, writer.finished()));
  if (until == header.bands()) writer.commit();
}

}  // namespace

TEST_CASE("map of a spatially varying BRDF: a written map is read back") {
  const scratch::folder here;
  const auto path = here / "map.gsv";
  const auto header = header_of(7, 5, 3);
  REQUIRE(header.bands() == 3);
  CHECK(header.texels_of_band(2) == 5);
  write_bands(path, header, 3);
  CHECK(here.entries() == 1);
  CHECK(io::is_svbrdf_map(path));
  const svbrdf_map map(path);
  CHECK(map.header().rows == 7);
  CHECK(map.header().columns == 5);
  CHECK(map.header().functions == header.functions);
  CHECK(map.header().eta == 2.5);
  CHECK(map.header().prior_source == "tests");
  REQUIRE(map.header().directions.size() == 2);
  CHECK(map.header().directions[1].wo == header.directions[1].wo);
  for (const Eigen::Index band : {2, 0, 1}) {
    const auto read = map.read_band(band), written = band_of(header, band);
    CHECK(read.weights == written.weights);
    CHECK(read.uncertainty == written.uncertainty);
    CHECK(read.disagreement == written.disagreement);
  }
  const auto numbers = estimates(header.texels_of_band(1), 4, 1);
  const Eigen::MatrixXd weights = io::weights_of_texel(map.header(), map.read_band(1), 6);
  REQUIRE(weights.rows() == 6);
  CHECK(weights.bottomRows(2).isZero(0.0));
  for (Eigen::Index c = 0; c < 3; ++c)
    for (Eigen::Index k = 0; k < 4; ++k)
      CHECK(weights(k, c) == doctest::Approx(double{numbers.weights(k, 18 + c)}).epsilon(1e-3));
  scratch::check_refused([&] { return map.read_band(3); }, {"map.gsv", "no band 3"});
}

TEST_CASE("map of a spatially varying BRDF: texels outside the sample are distinguished from tiny numbers") {
  auto found = estimates(4, 2, 1);
  found.uncertainty = Eigen::ArrayXf::Constant(4, 1e-12f);
  found.weights.setConstant(1e-12f);
  found.weights(1, 10) = 3.0f;
  found.clear(2);
  const auto band = io::as_halves(found);
  for (const Eigen::Index texel : {0, 1, 2, 3}) CHECK(band.has_material(texel) == (texel != 2));
  CHECK(band.disagreement[2] == 0);
  CHECK(std::count(band.weights.begin(), band.weights.end(), 0) == 21);
  CHECK(band.uncertainty[0] == 1);  // the smallest half float
  CHECK(band.weights[0] == 1);
  CHECK(band.weights[18] == 0);  // another weight of this texel is not zero
}

TEST_CASE("map of a spatially varying BRDF: an interrupted job resumes anywhere and writes the same bytes") {
  const scratch::folder here;
  const auto header = header_of(9, 4, 2);
  write_bands(here / "whole.gsv", header, header.bands());
  const std::string whole = scratch::get(here / "whole.gsv");
  for (std::size_t cut = 0; cut <= whole.size(); cut += cut < 300 ? 7 : 31) {
    scratch::put(here / "cut.gsv.part", whole.substr(0, cut));
    write_bands(here / "cut.gsv", header, header.bands());
    CHECK(scratch::get(here / "cut.gsv") == whole);
    CHECK(!scratch::fs::exists(here / "cut.gsv.part"));
  }
  // A damaged band and all later ones are written again.
  std::string damaged = whole;
  damaged[whole.size() / 2] ^= 1;
  scratch::put(here / "cut.gsv.part", damaged);
  {
    const svbrdf_writer writer(here / "cut.gsv", header);
    CHECK(writer.finished() > 0);
    CHECK(writer.finished() < header.bands());
    CHECK(writer.has_written(0, io::write_band(header, 0, band_of(header, 0))));
    CHECK(!writer.has_written(0, io::write_band(header, 0, band_of(header, 1))));
  }
  write_bands(here / "cut.gsv", header, header.bands());
  CHECK(scratch::get(here / "cut.gsv") == whole);
}

TEST_CASE("map of a spatially varying BRDF: another job's file, a second writer and an early commit are refused") {
  const scratch::folder here;
  const auto path = here / "map.gsv";
  const auto header = header_of(6, 4, 2);
  write_bands(path, header, 1);
  const std::string begun = scratch::get(here / "map.gsv.part");
  auto other = header;
  other.eta = 3.0;
  scratch::check_refused([&] { svbrdf_writer(path, other); }, {"map.gsv.part", "to another job"});
  CHECK(scratch::get(here / "map.gsv.part") == begun);
  svbrdf_writer writer(path, header);
  CHECK(writer.finished() == 1);
  scratch::check_refused([&] { svbrdf_writer(path, header); }, {"map.gsv", "another process is writing"});
  scratch::check_refused([&] { writer.commit(); }, {"1 of 3 bands"});
  scratch::check_refused([&] { writer.append(io::as_halves(estimates(3, 4, 1))); }, {"band 1 of 3 texels", "8"});
  scratch::check_refused([&] { writer.append(io::as_halves(estimates(8, 5, 1))); }, {"120 weights", "4 functions"});
  auto bytes = io::write_band(header, 1, band_of(header, 1));
  bytes[5] ^= std::byte{1};
  scratch::check_refused([&] { writer.append(bytes); }, {"map.gsv", "band 1 is damaged"});
  bytes.pop_back();
  scratch::check_refused([&] { writer.append(bytes); }, {"map.gsv", "band 1 is damaged"});
  CHECK(scratch::get(here / "map.gsv.part") == begun);
  other = header;
  CHECK(io::checksum_of(other) == io::checksum_of(header));
  other.eta = 2.75;
  CHECK(io::checksum_of(other) != io::checksum_of(header));
  scratch::fs::create_directory(here / "folder.gsv");
  scratch::check_refused([&] { svbrdf_writer(here / "folder.gsv", header); }, {"folder.gsv", "is a directory"});
  scratch::check_refused([&] { svbrdf_writer(here / "absent" / "map.gsv", header); }, {"map.gsv.part", "No such file"});
}

TEST_CASE("map of a spatially varying BRDF: bands written before the disk is full are kept") {
  const scratch::folder here;
  const auto path = here / "map.gsv";
  const auto header = header_of(64, 32, 4);
  // A limit of the file's size simulates a full disk: writing fails after the third band.
  const auto size = static_cast<rlim_t>(4 * 32 * (3 * 4 + 2) * 2 + 4);
  rlimit before{};
  REQUIRE(::getrlimit(RLIMIT_FSIZE, &before) == 0);
  auto* const handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit tight{4 * size, before.rlim_max};
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &tight) == 0);
  scratch::check_refused(
      [&] { write_bands(path, header, header.bands()); },
      {"map.gsv.part", "cannot be written", "the first 3 of 16 bands are kept, and the same job continues"});
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &before) == 0);
  std::signal(SIGXFSZ, handler);
  CHECK(svbrdf_writer(path, header).finished() == 3);
  write_bands(path, header, header.bands());
  CHECK(svbrdf_map(path).read_band(15).weights == band_of(header, 15).weights);
}

TEST_CASE("map of a spatially varying BRDF: damaged files and impossible headers are refused") {
  const scratch::folder here;
  const auto path = here / "map.gsv";
  scratch::check_refuses_non_files([](const auto& file) { return svbrdf_map(file).header().rows; });
  const auto header = header_of(5, 4, 2);
  write_bands(path, header, header.bands());
  const std::string whole = scratch::get(path);
  const auto read_all = [&](std::span<const std::byte> bytes) {
    scratch::put(path, bytes);
    const svbrdf_map map(path);
    for (Eigen::Index band = 0; band < map.header().bands(); ++band) static_cast<void>(map.read_band(band));
    return map.header().rows;
  };
  scratch::put(path, whole.substr(0, whole.size() - 1));
  scratch::check_refused([&] { return svbrdf_map(path).header().rows; }, {"map.gsv", "bytes, expected"});
  std::string other_version = whole;
  other_version[12] = 9;
  scratch::put(path, other_version);
  scratch::check_refused([&] { return svbrdf_map(path).header().rows; }, {"version 9", "reads version 1"});
  std::string damaged = whole;
  damaged[whole.size() - 9] ^= 1;
  scratch::put(path, damaged);
  scratch::check_refused([&] { return svbrdf_map(path).read_band(2).weights; }, {"checksum of band 2"});
  scratch::check_survives_damage(scratch::bytes_of(whole), 300, read_all);
  auto wrong = header;
  wrong.band_rows = 0;
  scratch::check_refused([&] { svbrdf_writer(here / "new.gsv", wrong); }, {"0 rows in a band"});
  wrong = header;
  wrong.eta = std::numeric_limits<double>::quiet_NaN();
  scratch::check_refused([&] { svbrdf_writer(here / "new.gsv", wrong); }, {"eta"});
  wrong = header;
  wrong.rows = wrong.columns = wrong.band_rows = 100'000;
  scratch::check_refused([&] { svbrdf_writer(here / "new.gsv", wrong); }, {"a band of"});
  CHECK(!scratch::fs::exists(here / "new.gsv.part"));
  auto large = estimates(8, 4, 1);
  large.weights(2, 5) = 7e4f;
  CHECK_THROWS_WITH_AS((void)io::as_halves(large), doctest::Contains("outside the range of half floats"), gonio::error);
}

TEST_CASE("map of a spatially varying BRDF: a prior is identified by its numbers") {
  const scratch::folder here;
  const auto prior = learn(synthetic_materials(small_cells(), 6), 4);
  const auto other = learn(synthetic_materials(small_cells(), 6, 8), 4);
  CHECK(io::checksum_of(prior) != io::checksum_of(other));
  auto header = header_of(2, 2, 2);
  header.prior_checksum = io::checksum_of(prior);
  header.functions = Eigen::MatrixXf::Identity(4, 2);
  write_bands(here / "map.gsv", header, 1);
  const svbrdf_map map(here / "map.gsv");
  map.require_prior(prior);
  scratch::check_refused([&] { map.require_prior(other); }, {"map.gsv", "another prior", "tests"});
}
