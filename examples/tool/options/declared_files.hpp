#pragma once
/// The files that a command reads and writes, compared before it runs: an output's name must fit its format, and an
/// output must be neither an input nor another output.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace cli {

class declared_files {
 public:
  /// Returns the paths of an option after the command line was read; empty ones were not given.
  using paths = std::function<std::vector<std::filesystem::path>()>;

  /// Errors name the `option`.
  void add_input(std::string option, paths given);
  /// Declares a folder whose files with these extensions are read.
  void add_input_folder(std::string option, paths given, std::vector<std::string> extensions);
  /// The name must end in one of the extensions, if there are any.
  void add_output(std::string option, paths given, std::vector<std::string> extensions);
  /// Declares a folder, which need not exist, into which files with these names are written.
  void add_output_folder(std::string option, paths given, std::vector<std::string> names);

  /// Throws gonio::error naming the option and the path that must not be written.
  void require_writable() const;
  /// The same for a path derived from an output's, for example with a number in its name.
  void require_writable(const std::filesystem::path& derived) const;

 private:
  struct declaration {
    std::string option;
    paths given;
    std::vector<std::string> names;  ///< extensions, or names of a folder's files
    bool is_folder = false;
  };
  struct output {
    std::string option;
    std::filesystem::path path;
  };

  [[nodiscard]] std::vector<output> outputs() const;
  void require_not_read(const output& written) const;

  std::vector<declaration> read_, written_;
};

}  // namespace cli
