#include "resumable_results.hpp"

#include "tool/options/threads_option.hpp"
#include <gonio/core/error.hpp>

#include <iterator>
#include <sstream>
#include <utility>

namespace papers {

namespace {

/// Returns the text that earlier runs left in a file.
std::string left_in(const std::filesystem::path& path) {
  if (std::filesystem::exists(path) && !std::filesystem::is_regular_file(path))
    gonio::refuse("'" + path.string() + "' is not a regular file");
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

void add_resumable_options(cli::command& to, resumable_options& options) {
  to.add_output("--state", options.state, {},
                "File that keeps the results; a later run computes only those that are missing");
  cli::add_threads_option(to, options.threads);
}

void run_together(const cli::team& processes, resumable_options& options, const std::function<void()>& work) {
  options.processes = &processes;
  options.threads = processes.threads(options.threads);
  processes.together(work);
}

resumable_results::resumable_results(const resumable_options& options)
    : processes_(*options.processes), path_(options.state) {
  std::string earlier;
  processes_.together([&] {
    if (!processes_.writes() || path_.empty()) return;
    earlier = left_in(path_);
    file_.open(path_, std::ios::app);
    if (!file_) gonio::refuse("cannot write '" + path_.string() + "'");
  });
  std::istringstream lines(processes_.text_of_writer(std::move(earlier)));
  for (std::string line; std::getline(lines, line);) {
    // Skip incomplete lines: a killed run may leave one.
    const json entry = json::read(line);
    if (entry.is_object() && entry.contains("key") && entry.contains("result"))
      results_.insert_or_assign(entry["key"].dump(), entry["result"]);
  }
  if (!results_.empty()) file_ << '\n';
}

const json* resumable_results::find(const json& key) const {
  const auto found = results_.find(key.dump());
  return found == results_.end() ? nullptr : &found->second;
}

const json& resumable_results::once(const json& key, std::size_t turn, const std::function<json()>& work) {
  static const json nothing;
  if (!find(key)) {
    json result;
    const auto done = processes_.compute_in_turn(turn, [&] {
      result = work();
      return cli::bytes_of(json{{"key", key}, {"result", result}}.dump());
    });
    if (!done) return nothing;
    if (!is_own(turn)) {
      const json entry = json::read(cli::text_of(*done));
      if (entry["key"].dump() != key.dump())
        gonio::refuse("the processes do different work: do they read different inputs?");
      result = entry["result"];
    }
    if (result.is_null()) return nothing;
    add(key, result);
  }
  return *find(key);
}

void resumable_results::add(const json& key, const json& result) {
  results_.insert_or_assign(key.dump(), result);
  if (!file_.is_open()) return;
  file_ << json{{"key", key}, {"result", result}}.dump() << std::endl;
  if (!file_) gonio::refuse("cannot write '" + path_.string() + "'");
}

}  // namespace papers
