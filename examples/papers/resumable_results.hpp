#pragma once
/// Results of a long experiment that survive its end.

#include "command_line/json.hpp"
#include "papers/experiments.hpp"
#include <gonio/core/error.hpp>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

namespace papers {

/// Results that earlier runs left in a file, one JSON object a line; new ones are appended as they come. Without a file
/// they are only remembered.
class resumable_results {
 public:
  explicit resumable_results(const std::filesystem::path& path) : path_(path) {
    if (path.empty()) return;
    if (std::filesystem::exists(path) && !std::filesystem::is_regular_file(path))
      gonio::refuse("'" + path.string() + "' is not a regular file");
    std::ifstream earlier(path);
    for (std::string line; std::getline(earlier, line);) {
      // A run that was killed may have left half a line.
      const json entry = json::parse(line);
      if (entry.is_object() && entry.contains("key") && entry.contains("result"))
        results_.insert_or_assign(entry["key"].dump(), entry["result"]);
    }
    file_.open(path, std::ios::app);
    if (!file_) gonio::refuse("cannot write '" + path.string() + "'");
    if (!results_.empty()) file_ << '\n';
  }

  /// Nothing if there is no such result.
  [[nodiscard]] const json* find(const json& key) const {
    const auto found = results_.find(key.dump());
    return found == results_.end() ? nullptr : &found->second;
  }

  void add(const json& key, const json& result) {
    results_.insert_or_assign(key.dump(), result);
    if (!file_.is_open()) return;
    file_ << json{{"key", key}, {"result", result}}.dump() << std::endl;
    if (!file_) gonio::refuse("cannot write '" + path_.string() + "'");
  }

 private:
  std::filesystem::path path_;
  std::map<std::string, json> results_;
  std::ofstream file_;
};

}  // namespace papers
