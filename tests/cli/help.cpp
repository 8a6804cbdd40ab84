/// The help of the tool.

#include "tool.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Returns the names of the subcommands that a help lists.
std::vector<std::string> listed(const std::string& help) {
  std::vector<std::string> names;
  for (const std::string& line : lines_of(help))
    if (line.size() > 30 && line.starts_with("  ") && std::islower(static_cast<unsigned char>(line[2])) != 0) {
      const std::string name = line.substr(2, line.find(' ', 2) - 2);
      if (line.substr(2 + name.size(), 2) == "  ") names.push_back(name);
    }
  return names;
}

/// Returns the example above the options of a help; empty if there is none.
std::string example_of(const std::string& help) {
  for (const std::string& line : lines_of(help))
    if (line.starts_with("  gonio ")) return line.substr(2);
  return "";
}

void check_help(const std::string& command) {
  CAPTURE(command);
  const std::string help = run(command + " --help");
  if (help.find("(not in this build)") != std::string::npos) return;
  for (const std::string& line : lines_of(help)) {
    CAPTURE(line);
    CHECK((line.size() <= 100 || line.find(' ', 30) == std::string::npos || line.starts_with("  -")));
  }
  const std::string example = example_of(help), all = run(command + " --help-all");
  REQUIRE_FALSE(example.empty());
  CHECK(example.starts_with("gonio " + command + " "));
  // Every option used in the example belongs to the command.
  std::istringstream words(example);
  for (std::string word; words >> word;)
    if (word.size() > 1 && word[0] == '-') {
      CAPTURE(word);
      CHECK((all.find("  " + word + " ") != std::string::npos || all.find("  " + word + ",") != std::string::npos));
    }
}

}  // namespace

TEST_CASE("gonio alone greets, and names the next step") {
  const auto result = gonio_tool("");
  CHECK(result.exit_code == 0);
  CHECK(result.output.find("gonio reconstruct") != std::string::npos);
  CHECK(result.output.find("gonio --help") != std::string::npos);
}

TEST_CASE("each subcommand is under a heading and has an example with options of its own") {
  const std::string help = run("--help");
  for (const char* heading : {"Measure:", "Reconstruct:", "Judge:", "Use:", "Laboratory:"})
    CHECK(help.find(std::string("\n") + heading + "\n") != std::string::npos);
  CHECK(help.find("\nSubcommands:\n") == std::string::npos);
  const std::vector<std::string> names = listed(help);
  CHECK(names.size() >= 19);
  for (const std::string& name : names)
    if (name != "shape") check_help(name);
  const std::vector<std::string> of_lab = listed(run("lab --help"));
  CHECK(of_lab.size() == 8);
  for (const std::string& name : of_lab) check_help("lab " + name);
}

TEST_CASE("reconstruct --help has the options of its default way, --help-all has all") {
  const std::string usual = run("reconstruct --help"), all = run("reconstruct --help-all");
  for (const char* option : {"--noise", "--output", "--report", "--method"}) {
    CHECK(usual.find(option) != std::string::npos);
    CHECK(all.find(option) != std::string::npos);
  }
  for (const char* option : {"--gamma", "--neighbours", "--lambda", "--networks"}) {
    CHECK(usual.find(std::string("  ") + option) == std::string::npos);
    CHECK(all.find(std::string("  ") + option) != std::string::npos);
  }
  CHECK(usual.find("gonio reconstruct --help-all prints more options") != std::string::npos);
  CHECK(all.find("prints more options") == std::string::npos);
  CHECK(run("info --help").find("--help-all") == std::string::npos);
}
