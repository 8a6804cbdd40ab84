#pragma once
/// Runs the built `gonio` tool as a user would.

#include "../run_program.hpp"

/// Runs `gonio ARGUMENTS` through the shell.
inline tool_result gonio_tool(const std::string& arguments) { return run_program(GONIO_TOOL, arguments); }
