#pragma once
/// Programs whose subcommands are done by the ranks of an MPI job.

#include "tool/options/command.hpp"
#include "tool/options/team.hpp"

#include <functional>
#include <string>
#include <vector>

namespace cli {

/// A program, and what adds its subcommands; `words` is the whole command line.
struct job {
  std::string name, description;
  std::function<void(command& app, const std::vector<std::string>& words, const team& processes)> add;
};

/// Reads the command line in each rank and does what it says. Rank 0 speaks for all. The exit code, which is 2 in all
/// ranks for bad input.
[[nodiscard]] int run_in_ranks(int argc, char** argv, const job& what);

}  // namespace cli
