#pragma once
/// The files that a command reads and writes, compared before it does either: what is written must have a name that its
/// format has, and must be none of the files that are read, nor another one that is written.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace cli {

class declared_files {
 public:
  /// The paths that an option has when the command line has been read; empty ones were not given.
  using paths = std::function<std::vector<std::filesystem::path>()>;

  /// `option` is what errors call it.
  void add_input(std::string option, paths given);
  /// Of a folder, the files with these extensions are read.
  void add_input_folder(std::string option, paths given, std::vector<std::string> extensions);
  /// The name must end in one of the extensions, if there are any.
  void add_output(std::string option, paths given, std::vector<std::string> extensions);
  /// Files of these names are written into a folder, which need not be there.
  void add_output_folder(std::string option, paths given, std::vector<std::string> names);

  /// Throws gonio::error naming the option and the path that must not be written.
  void require_writable() const;
  /// The same of a path that is made from an output's, like a number's put into its name.
  void require_writable(const std::filesystem::path& derived) const;

 private:
  struct declaration {
    std::string option;
    paths given;
    std::vector<std::string> names;  ///< extensions, or the names of a folder's files
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
