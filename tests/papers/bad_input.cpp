/// What gonio-papers refuses, in one line and with exit code 2.

#include "../io/scratch.hpp"
#include "papers_tool.hpp"

#include <doctest/doctest.h>
#include <sys/stat.h>

#include <algorithm>
#include <initializer_list>
#include <string>

namespace {

void refuses(const std::string& arguments, std::initializer_list<const char*> words) {
  CAPTURE(arguments);
  check_refusal(gonio_papers(arguments), words);
}

}  // namespace

TEST_CASE("help is no error") {
  for (const char* command : {"", "nielsen-test-materials ", "measured-materials ", "linear-combination ",
                              "noell-table1 ", "noell-table2 ", "noell-measured ", "noell-corrections ", "noell-gap ",
                              "noell-figures ", "directions ", "models ", "model-properties ", "model-recovery "}) {
    const auto result = gonio_papers(std::string(command) + "--help");
    CHECK(result.exit_code == 0);
    CHECK(result.output.size() > 100);
  }
}

TEST_CASE("a file of states may be nested to any depth, and is no pipe") {
  const scratch::folder folder;
  const std::string state = (folder / "state").string(), pipe = (folder / "pipe").string();
  scratch::put(state, std::string(200'000, '[') + "\n" + std::string(200'000, '[') + std::string(200'000, ']') + "\n");
  refuses("noell-table1 --networks /no/such/file.npy --state " + state, {"/no/such/file.npy"});
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  refuses("noell-table1 --networks /no/such/file.npy --state " + pipe, {"pipe", "not a regular file"});
}

TEST_CASE("bad requests of the experiments after Noell et al.") {
  const std::string table = "noell-table1 --networks n.npy ", measured = "noell-measured ";
  refuses(table + "--methods magic", {"magic"});
  refuses(table + "--methods gamma--1", {"gamma--1"});
  refuses(table + "--iterations 3 -1", {"--iterations", "-1"});
  refuses(table + "--data 0", {"--data"});
  refuses(table + "--outliers 1.5", {"--outliers"});
  refuses(table + "--state /no/such/folder/state", {"/no/such/folder/state"});
  refuses("noell-table2 --networks /no/such/file.npy", {"/no/such/file.npy"});
  refuses(measured + "--tables x", {"--networks"});
  refuses(measured + "--networks n.npy", {"--tables", "--samples"});
  refuses(measured + "--networks n.npy --data 2 --tables x", {"--data"});
  refuses(measured + "--networks n.npy --tables /no/such/folder", {"/no/such/folder"});
  refuses("noell-corrections --networks /no/such/file.npy", {"/no/such/file.npy"});
  refuses("noell-gap --networks n.npy", {"--environment"});
  refuses("noell-gap --networks n.npy --environment e.hdr --methods magic", {"magic"});
  refuses("noell-figures --networks n.npy --figure 6", {"--figure"});
}

TEST_CASE("bad requests of the experiment with a soft and a specular prior") {
  refuses("soft-specular", {"--networks"});
  refuses("soft-specular --networks n.npy --counts 3", {"--counts", "3"});
  refuses("soft-specular --networks n.npy --threshold much", {"--threshold", "much"});
  refuses("soft-specular --networks /no/such/file.npy", {"/no/such/file.npy"});
}
