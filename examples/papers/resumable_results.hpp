#pragma once
/// Results of a long experiment that survive an interruption, and that several processes share.

#include "tool/files/json.hpp"
#include "tool/options/command.hpp"
#include "tool/options/team.hpp"
#include "tool/pages/progress_bar.hpp"

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <string>

namespace papers {

using cli::json;

/// Options of experiments with resumable results.
struct resumable_options {
  std::filesystem::path state;  ///< the file that keeps results; none if empty
  gonio::thread_count threads;
  const cli::team* processes = &cli::alone();

  /// Returns whether this process has all results and prints them.
  [[nodiscard]] bool prints() const { return processes->writes(); }
};

void add_resumable_options(cli::command& to, resumable_options& options);

/// Runs the same work in all processes, each with its share of the machine's cores.
void run_together(const cli::team& processes, resumable_options& options, const std::function<void()>& work);

/// Makes a command run `work(options)` in all processes.
template <class Options, class Work>
void do_together(cli::command& command, const cli::team& processes, const std::shared_ptr<Options>& options,
                 Work work) {
  command.callback([=, &processes] { run_together(processes, *options, [&] { work(*options); }); });
}

/// Runs an experiment constructed from options and a progress bar. Passes the result of its `run()` to `print` in the
/// process that has all results.
template <class Experiment, class Options, class Print>
void run_and_print(const Options& options, const Print& print) {
  cli::progress_bar bar;
  Experiment work(options, bar);
  const auto found = work.run();
  if (!options.prints()) return;
  bar.wipe();
  print(found);
}

/// Keeps results in a file, one JSON object per line: reads those of earlier runs, and appends new ones immediately.
/// Without a file, keeps them only in memory.
///
/// All processes of a team run the same loop over the same keys. Each computes only the work of its own turns. The
/// process that writes has all results, in the order of the loop. Each other process has null for the turns of others,
/// and prints nothing.
class resumable_results {
 public:
  /// The writing process opens the file. Throws gonio::error if it cannot.
  explicit resumable_results(const resumable_options& options);

  /// Returns the result for `key`, computing it if necessary. One process does all work with the same `turn`, for
  /// example a material. Throws gonio::error if that process worked on another key.
  const json& once(const json& key, std::size_t turn, const std::function<json()>& work);

  /// Returns the result for `key`, or null if this process does not have it.
  [[nodiscard]] const json* find(const json& key) const;
  /// Returns whether this process does the work of a turn.
  [[nodiscard]] bool is_own(std::size_t turn) const { return turn % processes_.size() == processes_.number(); }

 private:
  void add(const json& key, const json& result);

  const cli::team& processes_;
  std::filesystem::path path_;
  std::map<std::string, json> results_;
  std::ofstream file_;
};

}  // namespace papers
