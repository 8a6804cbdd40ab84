#pragma once
/// The tool `gonio` as a process of its own, with what it costs.

#include <string>
#include <vector>

namespace papers {

struct process_cost {
  double seconds = 0.0, processor_seconds = 0.0, megabytes = 0.0;
  bool was_killed = false;
};

/// Runs `gonio WORDS`, which is beside this program; kills it after some seconds, if they are positive. Throws
/// gonio::error if it fails.
process_cost run_tool(const std::vector<std::string>& words, double kill_after = 0.0);

}  // namespace papers
