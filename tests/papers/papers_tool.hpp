#pragma once
/// Runs the built `gonio-papers` as a user would.

#include "../run_program.hpp"

/// Runs `gonio-papers ARGUMENTS` through the shell.
inline tool_result gonio_papers(const std::string& arguments) { return run_program(GONIO_PAPERS, arguments); }
