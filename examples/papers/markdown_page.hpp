#pragma once
/// `--markdown PAGE`: what an experiment prints replaces a block of a Markdown page. A block is
///
///     <!-- gonio-papers eta --networks merl_networks.npy -->
///     ... what the command printed, and when ...
///     <!-- end of gonio-papers -->
///
/// and its first line names the command: the options in the order given, files by their names alone, without
/// `--markdown`, `--state` and `--threads`, which do not change what is printed.

#include "papers/experiments.hpp"

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace papers {

/// The command as blocks name it. `arguments` starts with the experiment's name. `run -- PROGRAM ARGUMENTS` is named
/// by the program that it runs.
[[nodiscard]] std::string normalised_command(std::span<const std::string> arguments);

/// The page with `content` in the block of a command. Throws gonio::error where the page has not one such block.
[[nodiscard]] std::string with_block(std::string_view page, const std::filesystem::path& path,
                                     const std::string& command, const std::string& content);

/// The option, for all experiments at once.
class markdown_page {
 public:
  markdown_page(int argc, char** argv, std::string version);

  void add_option(command& to);
  /// Does the work of an experiment. If a page was given, it has a block for this command before the work starts, and
  /// what was printed in it after the work ended.
  void around(const std::function<void()>& work) const;

 private:
  /// When, by which command and how fast.
  [[nodiscard]] std::string origin(double seconds) const;

  std::vector<std::string> arguments_;
  std::string version_;
  std::filesystem::path path_;
};

}  // namespace papers
