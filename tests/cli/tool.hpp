#pragma once
/// Runs the built `gonio` tool as a user does.

#include "../run_program.hpp"

/// Runs `gonio ARGUMENTS` through the shell.
inline tool_result gonio_tool(const std::string& arguments) { return run_program(GONIO_TOOL, arguments); }

/// Runs the tool, which must succeed, and returns its output.
inline std::string run(const std::string& arguments) {
  const auto result = gonio_tool(arguments);
  REQUIRE_MESSAGE(result.exit_code == 0, arguments, ": ", result.output);
  return result.output;
}

inline void refuses(const std::string& arguments, std::initializer_list<const char*> words) {
  CAPTURE(arguments);
  check_refusal(gonio_tool(arguments), words);
}
