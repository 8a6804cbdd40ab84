#pragma once
/// Results of a long experiment that survive its end, and that several processes share.

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

/// What experiments with such results are told.
struct resumable_options {
  std::filesystem::path state;  ///< the file; none if empty
  gonio::thread_count threads;
  const cli::team* processes = &cli::alone();

  /// Has this process all results, and prints them?
  [[nodiscard]] bool prints() const { return processes->writes(); }
};

/// Adds `--state` and `--threads`.
void add_resumable_options(cli::command& to, resumable_options& options);

/// Does the same work in all processes, each with its share of the machine's cores.
void run_together(const cli::team& processes, resumable_options& options, const std::function<void()>& work);

/// Has a command do `work(options)` in all processes.
template <class Options, class Work>
void do_together(cli::command& command, const cli::team& processes, const std::shared_ptr<Options>& options,
                 Work work) {
  command.callback([=, &processes] { run_together(processes, *options, [&] { work(*options); }); });
}

/// Does an experiment that is made of options and a progress bar; what its `run()` found goes to `print` where all of
/// it is.
template <class Experiment, class Options, class Print>
void run_and_print(const Options& options, const Print& print) {
  cli::progress_bar bar;
  Experiment work(options, bar);
  const auto found = work.run();
  if (!options.prints()) return;
  bar.wipe();
  print(found);
}

/// Results that earlier runs left in a file, one JSON object a line; new ones are appended as they come. Without a file
/// they are only remembered.
///
/// Processes of a team run the same loop over the same keys. Each does the work whose turn is its own; the one that
/// writes has all results, in the order of the loop. Others have null for those of others, and print nothing.
class resumable_results {
 public:
  /// The process that writes reads and writes the file. Throws gonio::error if it cannot.
  explicit resumable_results(const resumable_options& options);

  /// The result of some work, which is done if it was not done before. Work of the same turn, that of one material say,
  /// is one process' own. Throws gonio::error if that process has done other work.
  const json& once(const json& key, std::size_t turn, const std::function<json()>& work);

  /// Nothing if there is no such result here.
  [[nodiscard]] const json* find(const json& key) const;
  /// Is work of this turn done here?
  [[nodiscard]] bool is_own(std::size_t turn) const { return turn % processes_.size() == processes_.number(); }

 private:
  void add(const json& key, const json& result);

  const cli::team& processes_;
  std::filesystem::path path_;
  std::map<std::string, json> results_;
  std::ofstream file_;
};

}  // namespace papers
