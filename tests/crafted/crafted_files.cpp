/// Files that are made to hurt: what they claim, how deep and how far they go. No reader may crash, throw anything but
/// gonio::error, take more than twice the file and 64 MiB, or more than two seconds.

#include "limited_child.hpp"
#include "made_files.hpp"
#include "refusals.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

using crafted::byte_vector;
using crafted::bytes_of;
using crafted::reads;
using crafted::refuses;

TEST_CASE("a prior's counts are not believed before its bytes are there") {
  refuses("prior", crafted::prior_of({.materials = 100'000'000 - 100}, 100'000'000), "cannot fit in");
  refuses("prior",
          crafted::prior_of({.theta_h = 4096, .theta_d = 1024, .components = 1000, .materials = 340}, 24 << 20),
          "cannot fit in");
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

TEST_CASE("a gzip file of zeros does not become a table of gigabytes") {
  byte_vector bomb = crafted::gzipped(crafted::merl_header({4096, 4096, 4096}), 0);
  const byte_vector member = crafted::gzipped({}, std::uint64_t{64} << 20);
  for (int i = 0; i < 64; ++i) crafted::append(bomb, member);  // 4 GiB
  refuses("merl", bomb, "cannot fit in");
  refuses("merl", crafted::gzipped(crafted::merl_header({1024, 64, 180}), 24ull * 1024 * 64 * 180), "cannot fit in");
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
  refuses("png", crafted::black_png(16384, 1, 0, 2049), "cannot fit in");
  refuses("png", crafted::black_png(8192, 8, 2, 3 * 8192 + 1), "cannot fit in");
  refuses("png", crafted::black_png(16385, 1, 0, 2049), "expected from 1 to 16384");
  reads("png", crafted::black_png(2000, 16, 6, 8 * 2000 + 1));
  reads("png", crafted::black_png(2000, 1, 0, 251));
  refuses("hdr", crafted::flat_hdr(16384), "cannot fit in");
  refuses("hdr", crafted::flat_hdr(8192), "cannot fit in");
  reads("hdr", crafted::flat_hdr(1024));
}

TEST_CASE("a message does not steer the terminal") {
  const auto npy = [](const std::string& dictionary) {
    return std::string("\x93NUMPY\x01\0", 8) + static_cast<char>(dictionary.size()) + '\0' + dictionary;
  };
  refuses("npy", npy("{'descr': '\x1b]0;title\x07', 'fortran_order': False, 'shape': (1,)}"), "\\x1b]0;title\\x07");
  refuses("npy", npy("{'\x1b[2J': 1}"), "\\x1b[2J");
  refuses("networks", "a\x1b[2J\na\x1b[2J\n", "\\x1b[2J");
  refuses("recorded_frames", "{\"largest_count\":9,\"frames\":[\"\\u007f\\u009b\"]}", "\\x7f\\xc2\\x9b");
  refuses("samples", "theta_h,\x1b[2J\n", "unknown columns: '?[2J'");
}

TEST_CASE("a direction that grazes the surface is refused in every way of reading it") {
  for (const char* row : {"89.9999999,0,-89.9999989,0", "89.9999999,0,89.9999999,180", "89.9999999999999,0,0,0",
                          "89.99999,10,89.99999,190"})
    crafted::read_in_child(crafted::reader_named("samples"),
                           bytes_of("theta_i,phi_i,theta_o,phi_o\n" + std::string(row) + "\n"));
}
