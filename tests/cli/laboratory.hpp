#pragma once
/// What the tests of `gonio lab` have in common.

#include "../io/scratch.hpp"
#include "tool.hpp"

#include <doctest/doctest.h>

#include <string>

inline const std::string directions = std::string(GONIO_SOURCE_DIR) + "/examples/data/nielsen-20.csv";

inline void refuses(const std::string& arguments, const std::string& words, int code = 2) {
  const auto result = gonio_tool(arguments);
  CAPTURE(arguments);
  CAPTURE(result.output);
  CHECK(result.exit_code == code);
  CHECK(result.output.find(words) != std::string::npos);
}

/// A table in a folder, and the files made from it.
struct laboratory {
  laboratory() { run("expand --formula red-paint -o " + at("truth.binary")); }

  [[nodiscard]] std::string at(const std::string& name) const { return (folder / name).string(); }

  scratch::folder folder;
  std::string material = " --material " + at("truth.binary") + " ";
};
