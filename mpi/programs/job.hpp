#pragma once
/// Programs whose subcommands run on the ranks of an MPI job.

#include "tool/options/command.hpp"
#include "tool/options/team.hpp"

#include <functional>
#include <string>
#include <vector>

namespace cli {

/// A program and the function that adds its subcommands. `words` is the whole command line.
struct job {
  std::string name, description;
  std::function<void(command& app, const std::vector<std::string>& words, const team& processes)> add;
};

/// Reads and runs the command line in each rank. Only rank 0 prints. Returns the exit code, which is 2 in all ranks for
/// bad input.
[[nodiscard]] int run_in_ranks(int argc, char** argv, const job& what);

}  // namespace cli
