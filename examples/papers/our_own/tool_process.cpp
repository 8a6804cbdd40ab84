#include "papers/our_own/tool_process.hpp"

#include <gonio/core/error.hpp>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

namespace papers {

process_cost run_tool(const std::vector<std::string>& words, double kill_after) {
  const std::string tool = (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "gonio").string();
  std::vector<std::string> all{tool};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> arguments;
  for (const std::string& word : all)
    arguments.push_back(const_cast<char*>(word.c_str()));  // exec does not modify them
  arguments.push_back(nullptr);
  const auto start = std::chrono::steady_clock::now();
  const pid_t child = ::fork();
  if (child < 0) gonio::refuse({"no process for gonio ", words.front()});
  if (child == 0) {
    const int nowhere = ::open("/dev/null", O_WRONLY);
    ::dup2(nowhere, 1);
    ::execv(tool.c_str(), arguments.data());
    ::_exit(127);
  }
  if (kill_after > 0.0) {
    std::this_thread::sleep_for(std::chrono::duration<double>(kill_after));
    ::kill(child, SIGKILL);
  }
  int status = 0;
  rusage used{};
  ::wait4(child, &status, 0, &used);
  process_cost cost{.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()};
  cost.was_killed = WIFSIGNALED(status);
  if (!cost.was_killed && WEXITSTATUS(status) != 0) gonio::refuse({tool, " ", words.front(), " failed"});
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  cost.processor_seconds = seconds(used.ru_utime) + seconds(used.ru_stime);
  cost.megabytes = static_cast<double>(used.ru_maxrss) / 1024.0;
  return cost;
}

}  // namespace papers
