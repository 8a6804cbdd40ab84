/// Files that are made to hurt: what they claim, how deep and how far they go. No reader may crash, throw anything but
/// gonio::error, take more than twice the file and 64 MiB, or more than two seconds.

#include "limited_child.hpp"
#include "made_files.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

using crafted::byte_vector;
using crafted::bytes_of;

namespace {

void refuses(const std::string& reader, const byte_vector& file, const std::string& words) {
  const crafted::report result = crafted::read_in_child(crafted::reader_named(reader), file);
  INFO(reader << ": " << result.message);
  CHECK(result.how == crafted::outcome::refused);
  CHECK(result.message.find(words) != std::string::npos);
}

void refuses(const std::string& reader, const std::string& text, const std::string& words) {
  refuses(reader, bytes_of(text), words);
}

void reads(const std::string& reader, const byte_vector& file) {
  const crafted::report result = crafted::read_in_child(crafted::reader_named(reader), file);
  INFO(reader << ": " << result.message);
  CHECK(result.how == crafted::outcome::read);
}

byte_vector content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return bytes_of(std::string(std::istreambuf_iterator<char>(file), {}));
}

}  // namespace

TEST_CASE("a prior's counts are not believed before its bytes are there") {
  refuses("prior", crafted::prior_of({.materials = 100'000'000 - 100}, 100'000'000), "not believable");
  refuses("prior",
          crafted::prior_of({.theta_h = 4096, .theta_d = 1024, .components = 1000, .materials = 340}, 24 << 20),
          "not believable");
  refuses("prior", crafted::prior_of({.materials = 2'000'000 - 100}, 2'000'000), "cannot hold");
  refuses("prior", crafted::prior_of({.theta_h = 1024, .theta_d = 1024, .components = 1000, .materials = 340}, 7 << 20),
          "cannot hold");
  refuses("prior", crafted::prior_of({.components = 0xFFFFFFFF, .materials = 0xFFFFFFFF}, 7 << 20), "cannot hold");
  refuses("prior", crafted::prior_of({.theta_h = 4096, .theta_d = 4096, .phi_d = 4096, .minimum_cosine = 0.9999}, 8000),
          "more cells");
  refuses("prior", crafted::prior_of({.theta_h = 0}, 8000), "extent");
  refuses("prior", crafted::prior_of({.theta_h = 1, .theta_d = 1, .phi_d = 1, .minimum_cosine = 0.999}, 8000),
          "above the horizon");
}

TEST_CASE("a prior of nothing but zeros is read in the memory that it takes") {
  // 90 x 90 x 180 cells, of which 1,096,216 are valid: a float each for reference, mean and component.
  const std::uint64_t rest = 8 + 4 * 2 + (8 + 12) + 2 * (8 + 2 * 1'096'216) + (8 + 1'096'216);
  reads("prior", crafted::prior_of({.theta_h = 90, .theta_d = 90, .phi_d = 180}, rest));
}

TEST_CASE("a shape model's counts are not believed before its bytes are there") {
  constexpr std::uint32_t most = 0xFFFFFFFF;
  refuses("shape_model", crafted::shapes_of({1, 1, 1, 100'000'000}, 100'000'000), "not believable");
  refuses("shape_model", crafted::shapes_of({1, 1, 1, 2'000'000 - 100}, 2'000'000), "impossible");
  refuses("shape_model", crafted::shapes_of({most, most, most, most}, 7 << 20), "impossible");
  // 3 x vertices x components wraps round to a few bytes in 64 bits.
  refuses("shape_model", crafted::shapes_of({1u << 31, 1, 1u << 31, 1u << 31}, 7 << 20), "impossible");
  refuses("shape_model", crafted::shapes_of({200'000, 300'000, 1, 1}, 8 + 8 + 3'600'000 + 12 + 4'800'000),
          "one vertex twice");
}

TEST_CASE("a gzip file of zeros does not become a table of gigabytes") {
  byte_vector bomb = crafted::gzipped(crafted::merl_header({4096, 4096, 4096}), 0);
  const byte_vector member = crafted::gzipped({}, std::uint64_t{64} << 20);
  for (int i = 0; i < 64; ++i) crafted::append(bomb, member);  // 4 GiB
  refuses("merl", bomb, "not believable");
  refuses("merl", crafted::gzipped(crafted::merl_header({1024, 64, 180}), 24ull * 1024 * 64 * 180), "not believable");
  refuses("gzip", member, "more than the expected");
  reads("merl", crafted::gzipped(crafted::merl_header({90, 90, 180}), 24ull * 90 * 90 * 180));
}

TEST_CASE("JSON of any depth and number of values ends no tool") {
  const std::size_t deep = 200'000;
  refuses("recorded_frames",
          "{\"largest_count\":255,\"frames\":[" + std::string(deep, '[') + std::string(deep, ']') + "]}",
          "is not a JSON object");
  refuses("recorded_frames", crafted::repeated("{\"a\":", deep) + "1" + std::string(deep, '}'), "is not a JSON object");
  reads("json", bytes_of(std::string(deep, '[')));
  reads("json", bytes_of(std::string(deep, '[') + std::string(deep, ']')));
  reads("json", bytes_of(std::string(100, '[') + std::string(100, ']')));
  refuses("recorded_frames", "[" + crafted::repeated("{},", 1'000'000) + "{}]", "is not a JSON object");
  refuses("recorded_frames", "{\"frames\":[" + crafted::repeated("[],", 200'000) + "1]}", "largest_count");
}

TEST_CASE("as many members of an object, or frames, as are read are read at once") {
  std::string members = "{", frames = "{\"largest_count\":9,\"frames\":[";
  for (int i = 0; i < 200'000; ++i) members += "\"" + std::to_string(i) + "\":0,";
  for (int i = 0; i < 35'000; ++i)
    frames += "{\"theta_i\":" + std::to_string(0.002 * i) +
              ",\"phi_i\":0,\"theta_o\":0,\"phi_o\":0,\"seconds\":1,\"file\":\"a\"},";
  frames.back() = ']';
  reads("json", bytes_of(members + "\"0\":1}"));
  refuses("recorded_frames", "{\"largest_count\":9,\"frames\":[" + members + "\"0\":1}]}", "theta_i");
  reads("recorded_frames", bytes_of(frames + "}"));
}

TEST_CASE("a small file is no large image") {
  refuses("png", crafted::black_png(16384, 1, 0, 2049), "not believable");
  refuses("png", crafted::black_png(8192, 8, 2, 3 * 8192 + 1), "not believable");
  refuses("png", crafted::black_png(16385, 1, 0, 2049), "expected from 1 to 16384");
  reads("png", crafted::black_png(2000, 16, 6, 8 * 2000 + 1));
  reads("png", crafted::black_png(2000, 1, 0, 251));
  refuses("hdr", crafted::flat_hdr(16384), "not believable");
  refuses("hdr", crafted::flat_hdr(8192), "not believable");
  reads("hdr", crafted::flat_hdr(1024));
}

TEST_CASE("a mesh's counts are not believed before its bytes are there") {
  const std::string vertices =
      "ply\nformat binary_little_endian 1.0\nelement vertex 2147483647\nproperty float x\n"
      "property float y\nproperty float z\nelement face 18446744073709551615\n"
      "property list uint int vertex_indices\nend_header\n";
  refuses("ply", vertices, "truncated");
  refuses("ply",
          "ply\nformat ascii 1.0\nelement face 18446744073709551615\nproperty list uint int vertex_indices\n"
          "end_header\n4294967295 0 0 0\n",
          "vertex 0 of a mesh of 0");
  refuses("ply", "ply\nformat ascii 1.0\nelement other 9\nproperty list uint int x\nend_header\n4294967295 0 0 0\n",
          "ends before");
  refuses("obj", "v 0 0 0\nf 1 1 9223372036854775807\n", "names vertex");
}

TEST_CASE("a message does not steer the terminal") {
  const auto npy = [](const std::string& dictionary) {
    return std::string("\x93NUMPY\x01\0", 8) + static_cast<char>(dictionary.size()) + '\0' + dictionary;
  };
  refuses("npy", npy("{'descr': '\x1b]0;title\x07', 'fortran_order': False, 'shape': (1,)}"), "\\x1b]0;title\\x07");
  refuses("npy", npy("{'\x1b[2J': 1}"), "\\x1b[2J");
  refuses("networks", "a\x1b[2J\na\x1b[2J\n", "\\x1b[2J");
  refuses("recorded_frames", "{\"largest_count\":9,\"frames\":[\"\\u007f\\u009b\"]}", "\\x7f\\xc2\\x9b");
  refuses("samples", "theta_h,\x1b[2J\n", "not known in it: '?[2J'");
}

TEST_CASE("a direction that grazes the surface is refused in every way of reading it") {
  for (const char* row : {"89.9999999,0,-89.9999989,0", "89.9999999,0,89.9999999,180", "89.9999999999999,0,0,0",
                          "89.99999,10,89.99999,190"})
    crafted::read_in_child(crafted::reader_named("samples"),
                           bytes_of("theta_i,phi_i,theta_o,phi_o\n" + std::string(row) + "\n"));
}

TEST_CASE("small files that were made by hand, and those that fuzzers found, are read or refused") {
  std::size_t files = 0;
  for (const char* folder : {"seeds", "found"})
    for (const fuzz::reader& reader : fuzz::readers()) {
      const std::filesystem::path here =
          std::filesystem::path(GONIO_SOURCE_DIR) / "tests" / "fuzz" / folder / reader.name;
      if (!std::filesystem::exists(here)) continue;
      for (const auto& entry : std::filesystem::directory_iterator(here)) {
        INFO(entry.path());
        const crafted::report result = crafted::read_in_child(reader, content_of(entry.path()));
        // Seeds are of the kind, or a fuzzer would begin with nothing; one grazes the surface.
        if (folder == std::string("seeds") && entry.path().filename() != "directions.csv")
          CHECK_MESSAGE(result.how == crafted::outcome::read, result.message);
        ++files;
      }
    }
  CHECK(files >= 2 * fuzz::readers().size());
}
