#pragma once
/// `--markdown PAGE`: the output of an experiment replaces a block of a Markdown page. A block is
///
///     <!-- gonio-papers eta --networks merl_networks.npy -->
///     ... what the command printed, and when ...
///     <!-- end of gonio-papers -->
///
/// The first line names the command: options in the order given, files without folders, and without `--markdown`,
/// `--state` and `--threads`, which do not change the output. Tables of more than 25 rows are folded.

#include "papers/experiments.hpp"

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace papers {

/// Returns the command as blocks name it. `arguments` starts with the experiment's name. `run -- PROGRAM ARGUMENTS` is
/// named after its program.
[[nodiscard]] std::string normalised_command(std::span<const std::string> arguments);

/// Returns the page with `content` in a command's block. Throws gonio::error unless the page has exactly one such
/// block.
[[nodiscard]] std::string with_block(std::string_view page, const std::filesystem::path& path,
                                     const std::string& command, const std::string& content);

/// The option `--markdown` for all experiments.
class markdown_page {
 public:
  markdown_page(int argc, char** argv, std::string version);

  void add_option(command& to);
  /// Runs the work of an experiment. If a page was given, checks before the work that it has a block for this command,
  /// and writes the output to the block afterwards.
  void around(const std::function<void()>& work) const;

 private:
  /// Returns date, command, version, threads and time.
  [[nodiscard]] std::string origin(double seconds) const;

  std::vector<std::string> arguments_;
  std::string version_;
  std::filesystem::path path_;
};

}  // namespace papers
