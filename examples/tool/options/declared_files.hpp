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
  /// Returns the paths of an option after the command line was read; an empty path was not given.
  using paths = std::function<std::vector<std::filesystem::path>()>;

  /// Declares files to read; errors name the `option`.
  void add_input(std::string option, paths given);
  /// Declares a folder whose files with these extensions are read.
  void add_input_folder(std::string option, paths given, std::vector<std::string> extensions);
  /// Declares files to write. If there are extensions, the files' names must end in one of them.
  void add_output(std::string option, paths given, std::vector<std::string> extensions);
  /// Declares a folder, which need not exist, into which files with these names are written.
  void add_output_folder(std::string option, paths given, std::vector<std::string> names);

  /// Throws gonio::error naming the option and the path that must not be written.
  void require_writable() const;
  /// Throws gonio::error if `derived` is an input. It is a path made from that of an output, for example by adding a
  /// number.
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
