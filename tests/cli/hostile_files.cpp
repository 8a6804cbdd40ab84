/// Files crafted to attack the tool: none makes it hang, crash, exhaust memory or write control sequences to the
/// terminal.

#include "../crafted/made_files.hpp"
#include "../io/scratch.hpp"
#include "tool.hpp"
#include <gonio/io/materials/prior.hpp>

#include <doctest/doctest.h>
#include <sys/stat.h>

#include <chrono>
#include <string>

namespace {

/// Checks for exit code 2 within ten seconds, and these words.
void refuses_soon(const std::string& arguments, const std::string& words) {
  const auto start = std::chrono::steady_clock::now();
  const auto result = run_program("timeout", "20 '" GONIO_TOOL "' " + arguments);
  CAPTURE(arguments);
  CAPTURE(result.output);
  CHECK(result.exit_code == 2);
  CHECK(result.output.find(words) != std::string::npos);
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(10));  // allows for sanitizers
}

[[nodiscard]] bool holds_controls(const std::string& text) {
  return std::ranges::any_of(text, [](char c) { return (c >= 0 && c < ' ' && c != '\n') || c == '\x7f'; });
}

}  // namespace

TEST_CASE("the tool does not wait for a pipe that nobody writes to") {
  const scratch::folder folder;
  const std::string pipe = (folder / "pipe").string();
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  REQUIRE(::mkfifo((pipe + ".csv").c_str(), 0600) == 0);
  refuses_soon("info " + pipe, "not a regular file");
  refuses_soon("info " + pipe + ".csv", "not a regular file");
  refuses_soon("reconstruct " + pipe + ".csv -o " + pipe + ".binary", "not a regular file");
  refuses_soon("lab replay " + pipe + " -o " + pipe + ".scan", "not a regular file");
}

TEST_CASE("nested JSON and empty images end a replay with one line") {
  const scratch::folder folder;
  const std::string manifest = (folder / "manifest.json").string(), scan = (folder / "out.scan").string();
  scratch::put(manifest,
               "{\"largest_count\":255,\"frames\":[" + std::string(200'000, '[') + std::string(200'000, ']') + "]}");
  refuses_soon("lab replay " + manifest + " -o " + scan, "nested at most 100 deep");
  scratch::put(manifest,
               std::string("{\"largest_count\":255,\"window\":{\"column\":0,\"row\":0,\"columns\":2,\"rows\":2},"
                           "\"frames\":[{\"theta_i\":10,\"phi_i\":0,\"theta_o\":20,\"phi_o\":0,\"seconds\":1,"
                           "\"file\":\"large.png\"}]}"));
  scratch::put(folder / "large.png", crafted::black_png(16384, 1, 0, 2049));
  const auto result = gonio_tool("lab replay " + manifest + " -o " + scan);
  CHECK(result.exit_code != 0);
  CHECK(result.output.find("large.png: an image of 16384 x 16384 pixels cannot fit in") != std::string::npos);
}

TEST_CASE("the tool shows what a file says without obeying it") {
  const scratch::folder folder;
  const std::string path = (folder / "odd.prior").string(), scan = (folder / "out.scan").string();
  const std::string evil = "\x1b]0;title\x07\x1b[2J\x7f";
  gonio::io::write_prior(path, gonio::io::read_prior(GONIO_SOURCE_DIR "/examples/data/materials.prior")
                                   .truncated(1)
                                   .with_source("paints" + evil));
  for (const char* option : {"", " --json"}) {
    const auto result = gonio_tool("info " + path + option);
    CHECK(result.exit_code == 0);
    CHECK(result.output.find("paints") != std::string::npos);
    CHECK_FALSE(result.output.find('\x1b') != std::string::npos);
  }
  CHECK_FALSE(holds_controls(gonio_tool("info " + path).output));
  scratch::put(folder / "manifest.json",
               std::string("{\"largest_count\":255,\"frames\":[{\"theta_i\":10,\"phi_i\":0,\"theta_o\":20,\"phi_o\":0,"
                           "\"seconds\":1,\"file\":\"\\u001b[2J\\u007f.png\"}]}"));
  const auto replay = gonio_tool("lab replay " + (folder / "manifest.json").string() + " -o " + scan);
  CHECK(replay.output.find("\\x1b[2J\\x7f.png") != std::string::npos);
  CHECK_FALSE(holds_controls(replay.output));
}

TEST_CASE("samples that cannot be completed are blamed, not the table that would be written") {
  const scratch::folder folder;
  const std::string path = (folder / "bright.csv").string(), output = (folder / "out.binary").string();
  scratch::put(path, std::string("theta_h,theta_d,phi_d,r,g,b\n10,20,30,1e39,1,1\n"));
  refuses_soon("reconstruct " + path + " -o " + output + " --method pull-push",
               "bright.csv, line 2: column r: 1e+39 sr^-1 is outside the range of float");
  scratch::put(path,
               std::string("theta_h,theta_d,phi_d,r,g,b\n10,20,30,1e38,1,1\n11,20,30,1e38,1,1\n20,30,40,1,1,1\n"));
  refuses_soon("reconstruct " + path + " -o " + output + " --method pca",
               "bright.csv: these samples, up to 1e+38 sr^-1, lead to a table that is not finite");
  CHECK_FALSE(std::filesystem::exists(output));
}

TEST_CASE("a step of lights with a negative tolerance is refused") {
  const scratch::folder folder;
  const std::string path = (folder / "arc.txt").string();
  scratch::put(path, std::string("light_step 7.5 -1\n"));
  refuses_soon("design --constraint " + path + " -n 2 -o " + (folder / "out.csv").string(),
               "arc.txt, line 1: the tolerance of an angle must be from 0 to 90 degrees");
}
