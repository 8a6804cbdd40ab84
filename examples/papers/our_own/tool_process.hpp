#pragma once
/// Runs the tool `gonio` as a process and measures its cost.

#include <string>
#include <vector>

namespace papers {

struct process_cost {
  double seconds = 0.0, processor_seconds = 0.0, megabytes = 0.0;
  bool was_killed = false;
};

/// Runs `gonio WORDS`; the tool is in this program's folder. Kills it after some seconds if they are positive. Throws
/// gonio::error if it fails.
process_cost run_tool(const std::vector<std::string>& words, double kill_after = 0.0);

}  // namespace papers
