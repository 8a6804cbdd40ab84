#include "scratch.hpp"
#include <gonio/io/bytes/byte_stream.hpp>
#include <gonio/io/materials/mbsdf.hpp>
#include <gonio/model/ggx.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

using gonio::io::mbsdf_material;
using gonio::io::read_mbsdf;
using scratch::bytes_of;
using scratch::check_refused;

namespace {

const std::string magic = "NVIDIA ARC MBSDF V1\n";

/// A block with the values 0, 1, 2, ...
std::string block(const std::string& ident, std::uint32_t type, std::uint32_t polar, std::uint32_t azimuth) {
  gonio::io::byte_writer writer;
  writer.write_bytes(ident.data(), ident.size());
  writer.write('\n');
  writer.write(type);
  writer.write(polar);
  writer.write(azimuth);
  const std::uint32_t count = polar * polar * azimuth * (type == 0 ? 1 : 3);
  for (std::uint32_t i = 0; i < count; ++i) writer.write(static_cast<float>(i));
  return {reinterpret_cast<const char*>(writer.bytes().data()), writer.bytes().size()};
}

mbsdf_material read_text(const std::string& content) { return read_mbsdf(bytes_of(content), "paint.mbsdf"); }

void check_mbsdf_refused(const std::string& content, std::initializer_list<std::string> words) {
  check_refused([&] { return read_text(content); }, {"paint.mbsdf"});
  check_refused([&] { return read_text(content); }, words);
}

}  // namespace

TEST_CASE("MBSDF: a block has its type and sizes, then values; phi varies fastest, theta_in slowest") {
  const mbsdf_material scalar = read_text(magic + block("MBSDF_DATA=", 0, 2, 3));
  CHECK(scalar.reflection.grid() == gonio::model::polar_grid{2, 3});
  CHECK(scalar.reflection.channels() == 1);
  CHECK(scalar.reflection.values()[11] == 11.0f);
  CHECK(!scalar.has_transmission);
  CHECK(scalar.metadata.empty());
  const auto wi = gonio::spherical_direction(gonio::radians(22.5), 0.0);
  const auto wo = gonio::spherical_direction(gonio::radians(67.5), gonio::radians(150.0));
  CHECK(scalar.reflection.as_measured(wi, wo)[2] == doctest::Approx(5.0));
  const mbsdf_material rgb = read_text(magic + block("MBSDF_DATA_REFLECTION=", 1, 2, 3));
  CHECK(rgb.reflection.channels() == 3);
  CHECK((rgb.reflection.as_measured(wi, wo) - gonio::rgb(15, 16, 17)).abs().maxCoeff() < 1e-9);
}

TEST_CASE("MBSDF: metadata is read, transmission is skipped") {
  const std::string said = "name=\"red \\\"car\\\" paint\\\\2\"\nnotes=\"two\\nlines\"\nno entry\nempty=\"\"\n";
  const mbsdf_material both =
      read_text(magic + said + block("MBSDF_DATA_REFLECTION=", 0, 2, 3) + block("MBSDF_DATA_TRANSMISSION=", 0, 2, 4));
  CHECK(both.has_transmission);
  CHECK(both.reflection.values().size() == 12);
  CHECK(both.metadata.at("name") == "red \"car\" paint\\2");
  CHECK(both.metadata.at("notes") == "two\nlines");
  CHECK(both.metadata.at("empty").empty());
  CHECK(both.metadata.size() == 3);
}

TEST_CASE("MBSDF: a file is read and written again byte for byte") {
  const scratch::folder here;
  const gonio::model::ggx rough{.alpha = 0.4, .f0 = gonio::rgb(0.9, 0.6, 0.3)};
  const gonio::io::mbsdf_metadata metadata{{"name", "gold \"rough\"\n"}, {"path", "a\\b"}};
  gonio::io::write_mbsdf(here / "t.mbsdf", rough, {8, 16}, metadata);
  const mbsdf_material again = gonio::io::read_mbsdf(here / "t.mbsdf");
  CHECK(again.metadata == metadata);
  CHECK(std::ranges::equal(again.reflection.values(), gonio::model::tabulate_polar(rough, {8, 16}).values()));
  gonio::io::write_mbsdf(here / "u.mbsdf", again);
  CHECK(scratch::get(here / "u.mbsdf") == scratch::get(here / "t.mbsdf"));
  CHECK(scratch::get(here / "t.mbsdf").starts_with(magic + "name=\"gold \\\"rough\\\"\\n\"\n"));
  CHECK(here.entries() == 2);
}

TEST_CASE("MBSDF: keys must be words, characters outside ASCII are replaced") {
  mbsdf_material material{{{1, 1}, {0.5f}}, {{"two words", "x"}}};
  check_refused([&] { return gonio::io::write_mbsdf(material); }, {"two words"});
  material.metadata = {{"name", "gr\xC3\xBCn\t ~\x7F"}};
  CHECK(read_mbsdf(gonio::io::write_mbsdf(material), "t").metadata.at("name") == "gr??n? ~?");
}

TEST_CASE("MBSDF: bad files are refused") {
  scratch::check_refuses_non_files([](const auto& path) { return gonio::io::read_mbsdf(path); });
  const std::string good = magic + block("MBSDF_DATA=", 0, 2, 3);
  check_mbsdf_refused("file format error " + good, {"NVIDIA ARC MBSDF V1"});
  check_mbsdf_refused(magic, {"no line MBSDF_DATA_REFLECTION="});
  check_mbsdf_refused(magic + "name=\"x\"\n", {"no line MBSDF_DATA_REFLECTION="});
  check_mbsdf_refused(magic + block("MBSDF_DATA_TRANSMISSION=", 0, 2, 3), {"only transmission"});
  check_mbsdf_refused(magic + block("MBSDF_DATA=", 2, 1, 1), {"type 2"});
  check_mbsdf_refused(magic + block("MBSDF_DATA=", 0, 0, 3), {"no cells"});
  check_mbsdf_refused(good.substr(0, good.size() - 1), {"truncated"});
  check_mbsdf_refused(good.substr(0, magic.size() + 20), {"truncated"});
  check_mbsdf_refused(good + "x", {"expected"});
  check_mbsdf_refused(good + "x\n", {"expected MBSDF_DATA_TRANSMISSION="});
  check_mbsdf_refused(good + block("MBSDF_DATA_TRANSMISSION=", 0, 1, 1) + "x", {"1 bytes after"});
  std::string counted = good;
  counted.replace(magic.size() + 16, 8, 8, '\xFF');
  check_mbsdf_refused(counted, {"4294967295 x 4294967295", "truncated"});
  std::string nan = good;
  const float not_a_number = std::numeric_limits<float>::quiet_NaN();
  nan.replace(nan.size() - 4, 4, reinterpret_cast<const char*>(&not_a_number), 4);
  check_mbsdf_refused(nan, {"value 11", "not finite"});
}

TEST_CASE("MBSDF: damaged files are read or refused") {
  const std::string both =
      magic + "name=\"x\"\n" + block("MBSDF_DATA_REFLECTION=", 1, 2, 3) + block("MBSDF_DATA_TRANSMISSION=", 0, 2, 2);
  scratch::check_survives_damage(bytes_of(both), 3000,
                                 [](std::span<const std::byte> bytes) { return read_mbsdf(bytes, "t"); });
}
