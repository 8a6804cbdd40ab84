/// `gonio-papers run`: runs another program of the repository that prints a table.

#include "papers/experiments.hpp"
#include <gonio/core/error.hpp>

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

namespace papers {

namespace {

/// Quotes a word for the shell.
std::string quoted(const std::string& word) {
  std::string all = "'";
  for (const char letter : word) all += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
  return all + "'";
}

void run(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += quoted(word) + ' ';
  std::FILE* pipe = ::popen(line.c_str(), "r");
  if (pipe == nullptr) gonio::refuse("cannot run '" + words[0] + "'");
  std::array<char, 4096> buffer{};
  for (std::size_t count = 0; (count = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    std::cout.write(buffer.data(), static_cast<std::streamsize>(count)).flush();
  const int status = ::pclose(pipe);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) gonio::refuse("'" + words[0] + "' failed");
}

}  // namespace

void add_run(command& app) {
  auto command = app.add_subcommand(
      "run", "Run another program that prints a table: gonio-papers run --markdown PAGE -- PROGRAM ARGUMENTS");
  const auto words = std::make_shared<std::vector<std::string>>();
  command.add_option("program", *words, "The program and its arguments").required();
  command.callback([words] { run(*words); });
}

}  // namespace papers
