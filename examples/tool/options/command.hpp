#pragma once
/// The command line's commands, options and checks, and a program that runs them. They hide CLI11, which takes seconds
/// to compile: only command.cpp includes it. Everything here except `program` is a handle, cheap to copy, to objects
/// that the program owns.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
class Option;
class Validator;
}  // namespace CLI

namespace cli {

/// A condition on the values of an option. `first & second` requires both.
class check {
 public:
  [[nodiscard]] static check positive_number();
  [[nodiscard]] static check non_negative_number();
  /// Accepts values from `lowest` to `highest`, both included. The value must be a number of their type.
  [[nodiscard]] static check range(double lowest, double highest);
  [[nodiscard]] static check range(int lowest, int highest);
  [[nodiscard]] static check range(unsigned lowest, unsigned highest);
  [[nodiscard]] static check one_of(std::vector<std::string> words);
  [[nodiscard]] static check one_of(std::initializer_list<int> numbers);
  /// `complaint(value)` returns why the value is refused, or an empty text. The help calls the value `type`.
  [[nodiscard]] static check without(std::function<std::string(const std::string&)> complaint, const std::string& type);

  friend check operator&(const check& first, const check& second);

 private:
  friend class option;
  explicit check(const CLI::Validator& known);

  std::shared_ptr<const CLI::Validator> known_;
};

/// A handle to an option. All functions return the option, for chaining.
class option {
 public:
  option required();
  option check(const cli::check& wanted);
  /// Shows the variable's current value as the default.
  option capture_default_str();
  option default_str(const std::string& text);
  option type_name(const std::string& name);
  /// Takes one value per use, and keeps all values.
  option repeatable();
  option needs(option other);
  option excludes(option other);

 private:
  friend class command;
  explicit option(CLI::Option& known) : known_(&known) {}

  CLI::Option* known_;
};

class option_group;
class declared_files;

/// A subcommand. The variables of its options must outlive the program's run.
class command {
 public:
  command add_subcommand(const std::string& name, const std::string& description);
  /// Extends each subcommand that is added later: `added` may add options to it, and `around(work)` runs instead of its
  /// work and must call `work`.
  void extend_subcommands(std::function<void(command&)> added,
                          std::function<void(const std::function<void()>&)> around);
  option_group add_option_group(const std::string& name, const std::string& description);
  /// Lists subcommands under a heading, and prints an example above the options of each. A nested one, such as "lab
  /// scan", gets only the example. Ignores subcommands that the program does not have.
  struct listed {
    const char* name;
    const char* example;
  };
  void list_subcommands(const std::string& heading, std::initializer_list<listed> subcommands);
  /// Prints only these options in --help; --help-all prints all.
  void help_with(const std::vector<std::string>& options);
  void require_subcommand();
  /// Accepts words that are not options.
  void allow_extras();

  option add_option(const std::string& names, std::string& value, const std::string& description);
  option add_option(const std::string& names, int& value, const std::string& description);
  option add_option(const std::string& names, unsigned& value, const std::string& description);
  option add_option(const std::string& names, unsigned long& value, const std::string& description);
  option add_option(const std::string& names, unsigned long long& value, const std::string& description);
  /// These options are for counts and positions (`Eigen::Index`). They refuse negative numbers.
  option add_option(const std::string& names, std::ptrdiff_t& value, const std::string& description);
  option add_option(const std::string& names, std::vector<std::ptrdiff_t>& values, const std::string& description);
  option add_option(const std::string& names, double& value, const std::string& description);
  option add_option(const std::string& names, std::optional<double>& value, const std::string& description);
  option add_option(const std::string& names, std::vector<std::string>& values, const std::string& description);
  option add_option(const std::string& names, std::vector<int>& values, const std::string& description);
  option add_option(const std::string& names, std::vector<unsigned long>& values, const std::string& description);
  option add_option(const std::string& names, std::vector<unsigned long long>& values, const std::string& description);
  option add_option(const std::string& names, std::vector<double>& values, const std::string& description);
  option add_option(const std::string& names, std::pair<int, int>& values, const std::string& description);
  /// Deleted: files must be declared as inputs or outputs. Before the command runs, they are compared: no output may
  /// overwrite an input.
  option add_option(const std::string& names, std::filesystem::path& value, const std::string& description) = delete;
  option add_option(const std::string& names, std::vector<std::filesystem::path>& values,
                    const std::string& description) = delete;
  option add_input(const std::string& names, std::filesystem::path& value, const std::string& description);
  option add_input(const std::string& names, std::vector<std::filesystem::path>& values,
                   const std::string& description);
  /// Files in pairs.
  option add_input(const std::string& names, std::vector<std::pair<std::string, std::string>>& values,
                   const std::string& description);
  /// Adds an option for a folder whose files with these extensions are read.
  option add_input_folder(const std::string& names, std::filesystem::path& value,
                          std::initializer_list<const char*> extensions, const std::string& description);
  option add_input_folders(const std::string& names, std::vector<std::filesystem::path>& values,
                           std::initializer_list<const char*> extensions, const std::string& description);
  /// Adds an option for a file to write. If there are extensions, the file's name must end in one of them.
  option add_output(const std::string& names, std::filesystem::path& value,
                    std::initializer_list<const char*> extensions, const std::string& description);
  /// Adds an option for a folder into which files with these names are written.
  option add_output_folder(const std::string& names, std::filesystem::path& value,
                           std::initializer_list<const char*> files, const std::string& description);
  /// Throws gonio::error if `derived`, a name made from that of an output, is an input.
  void require_writable(const std::filesystem::path& derived) const;

  /// Adds an option that takes one of `words`, in upper or lower case; `choose` receives the number of the word.
  option add_choice(const std::string& names, std::function<void(int)> choose,
                    std::initializer_list<std::pair<const char*, int>> words, const std::string& description);
  option add_flag(const std::string& names, bool& value, const std::string& description);

  /// Sets the command's work, which runs after the command line is read and the files are compared.
  void callback(std::function<void()> work);
  /// Returns how often an option was given.
  [[nodiscard]] std::size_t count(const std::string& name) const;

 protected:
  struct extension;

  command(CLI::App& known, std::shared_ptr<declared_files> files, std::shared_ptr<const extension> extended = nullptr)
      : known_(&known), files_(std::move(files)), extended_(std::move(extended)) {}
  [[nodiscard]] CLI::App& known() const noexcept { return *known_; }

 private:
  CLI::App* known_;
  std::shared_ptr<declared_files> files_;      ///< of the subcommand and its groups
  std::shared_ptr<const extension> extended_;  ///< set by the parent command; may be null
};

/// A group of options; `require_option` states how many of them must be given.
class option_group : public command {
 public:
  void require_option(std::size_t number);
  void require_option(std::size_t least, std::size_t most);

 private:
  friend class command;
  using command::command;
};

/// The whole command line. Bad input is reported in one line that begins with the program's name.
class program : public command {
 public:
  program(const std::string& name, const std::string& description, const std::string& version);
  program(const program&) = delete;
  program& operator=(const program&) = delete;
  ~program();

  /// Sets the text to print if the command line has no words.
  void greet_with(std::string greeting) { greeting_ = std::move(greeting); }

  /// Reads and executes the command line. Returns the exit code: 2 for bad input, 1 for any other failure or a negative
  /// answer.
  [[nodiscard]] int run(int argc, char** argv);

 private:
  program(std::string name, std::unique_ptr<CLI::App> all);

  std::string name_, greeting_;
  std::unique_ptr<CLI::App> all_;
};

}  // namespace cli
