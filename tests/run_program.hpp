#pragma once
/// Runs one of our programs as a user would.

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

struct tool_result {
  int exit_code = -1;
  std::string output;  ///< standard output and error together
};

/// Runs `PROGRAM ARGUMENTS` through the shell.
inline tool_result run_program(const std::string& program, const std::string& arguments) {
  tool_result result;
  std::FILE* pipe = ::popen(("'" + program + "' " + arguments + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return result;
  std::array<char, 4096> buffer{};
  for (std::size_t count = 0; (count = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    result.output.append(buffer.data(), count);
  const int status = ::pclose(pipe);
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return result;
}
