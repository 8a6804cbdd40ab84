#pragma once
/// Runs one of our programs as a user would.

#include <doctest/doctest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <initializer_list>
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

/// Exit code 2, one line, and the words that help.
inline void check_refusal(const tool_result& result, std::initializer_list<const char*> words) {
  CAPTURE(result.output);
  CHECK(result.exit_code == 2);
  CHECK(std::ranges::count(result.output, '\n') == 1);
  for (const char* word : words) CHECK(result.output.find(word) != std::string::npos);
}
