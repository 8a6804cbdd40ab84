#include "command.hpp"

#include "declared_files.hpp"
#include "help_formatter.hpp"
#include "negative_answer.hpp"
#include "tool/files/exr_files.hpp"
#include <gonio/core/error.hpp>
#include <gonio/core/printable.hpp>
#include <gonio/core/spelling.hpp>
#include <gonio/io/bytes/file.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <csignal>
#include <exception>
#include <iostream>
#include <map>
#include <new>
#include <sstream>

namespace cli {

namespace {

constexpr int bad_input = 2;
constexpr int failure = 1;
constexpr int no = 1;

/// The number of a word. CLI11 handles an enumeration's values as numbers and does not print them.
enum class word_number : int {};

}  // namespace

// ---- checks --------------------------------------------------------------------------------------------------------

namespace {

/// Returns a check with its own message: CLI11 would print the range's end, the largest double, in 309 digits.
CLI::Validator saying(const CLI::Validator& known, const std::string& complaint) {
  return CLI::Validator(
      [known, complaint](std::string& text) { return known(text).empty() ? "" : text + " " + complaint; },
      known.get_description());
}

constexpr const char* not_of_zero_or_more = "is not a number of at least 0";

}  // namespace

check::check(const CLI::Validator& known) : known_(std::make_shared<const CLI::Validator>(known)) {}

check check::positive_number() { return check(saying(CLI::PositiveNumber, "is not a positive number")); }
check check::non_negative_number() { return check(saying(CLI::NonNegativeNumber, not_of_zero_or_more)); }
check check::range(double lowest, double highest) { return check(CLI::Range(lowest, highest)); }
check check::range(int lowest, int highest) { return check(CLI::Range(lowest, highest)); }
check check::range(unsigned lowest, unsigned highest) { return check(CLI::Range(lowest, highest)); }
check check::one_of(std::vector<std::string> words) { return check(CLI::IsMember(std::move(words))); }
check check::one_of(std::initializer_list<int> numbers) { return check(CLI::IsMember(numbers)); }

check check::without(std::function<std::string(const std::string&)> complaint, const std::string& type) {
  return check(CLI::Validator([complaint = std::move(complaint)](std::string& text) { return complaint(text); }, type));
}

check operator&(const check& first, const check& second) { return check(*first.known_ & *second.known_); }

// ---- options -------------------------------------------------------------------------------------------------------

option option::required() { return option(*known_->required()); }
option option::check(const cli::check& wanted) { return option(*known_->check(*wanted.known_)); }
option option::capture_default_str() { return option(*known_->capture_default_str()); }
option option::default_str(const std::string& text) { return option(*known_->default_str(text)); }
option option::type_name(const std::string& name) { return option(*known_->type_name(name)); }
option option::repeatable() { return option(*known_->expected(1)->take_all()); }
option option::needs(option other) { return option(*known_->needs(other.known_)); }
option option::excludes(option other) { return option(*known_->excludes(other.known_)); }

// ---- commands ------------------------------------------------------------------------------------------------------

struct command::extension {
  std::function<void(command&)> added;
  std::function<void(const std::function<void()>&)> around;
};

void command::extend_subcommands(std::function<void(command&)> added,
                                 std::function<void(const std::function<void()>&)> around) {
  extended_ = std::make_shared<const extension>(extension{std::move(added), std::move(around)});
}

command command::add_subcommand(const std::string& name, const std::string& description) {
  command added(*known_->add_subcommand(name, description), std::make_shared<declared_files>(), extended_);
  if (extended_) extended_->added(added);
  return added;
}

option_group command::add_option_group(const std::string& name, const std::string& description) {
  return {*known_->add_option_group(name, description), files_};
}

void command::list_subcommands(const std::string& heading, std::initializer_list<listed> subcommands) {
  for (const auto& [name, example] : subcommands) {
    std::istringstream words(name);
    CLI::App* found = known_;
    for (std::string word; found != nullptr && words >> word;) {
      const auto known = found->get_subcommands([&](const CLI::App* each) { return each->get_name() == word; });
      found = known.empty() ? nullptr : known.front();
    }
    if (found == nullptr) continue;
    found->footer(std::string("  ") + example);
    if (found->get_parent() == known_) found->group(heading);
  }
}

void command::help_with(const std::vector<std::string>& options) {
  for (CLI::Option* each : known_->get_options())
    if (each->nonpositional() && each != known_->get_help_ptr() && each != known_->get_help_all_ptr() &&
        std::ranges::none_of(options, [&](const std::string& name) { return each->check_name(name); }))
      each->group(help_formatter::rare_options);
  for (CLI::App* group : known_->get_subcommands(nullptr))
    if (group->get_name().empty()) command(*group, files_).help_with(options);
}

void command::require_subcommand() { known_->require_subcommand(1); }
void command::allow_extras() { known_->allow_extras(); }

option command::add_option(const std::string& names, std::string& value, const std::string& description) {
  return option(*known_->add_option(names, value, description));
}

option command::add_option(const std::string& names, int& value, const std::string& description) {
  return option(*known_->add_option(names, value, description));
}

option command::add_option(const std::string& names, unsigned& value, const std::string& description) {
  return option(*known_->add_option(names, value, description));
}

option command::add_option(const std::string& names, unsigned long& value, const std::string& description) {
  return option(*known_->add_option(names, value, description));
}

option command::add_option(const std::string& names, unsigned long long& value, const std::string& description) {
  return option(*known_->add_option(names, value, description));
}

namespace {

/// Sets up an integer that must not be negative, with the type name that the help uses for such integers.
CLI::Option& counting(CLI::Option& added) {
  return *added.type_name("UINT")->check(saying(CLI::NonNegativeNumber, not_of_zero_or_more).description(""));
}

}  // namespace

option command::add_option(const std::string& names, std::ptrdiff_t& value, const std::string& description) {
  return option(counting(*known_->add_option(names, value, description)));
}

option command::add_option(const std::string& names, std::vector<std::ptrdiff_t>& values,
                           const std::string& description) {
  return option(counting(*known_->add_option(names, values, description)));
}

option command::add_option(const std::string& names, double& value, const std::string& description) {
  return option(*known_->add_option(names, value, description));
}

option command::add_option(const std::string& names, std::optional<double>& value, const std::string& description) {
  return option(*known_->add_option(names, value, description));
}

option command::add_option(const std::string& names, std::vector<std::string>& values, const std::string& description) {
  return option(*known_->add_option(names, values, description));
}

option command::add_option(const std::string& names, std::vector<int>& values, const std::string& description) {
  return option(*known_->add_option(names, values, description));
}

option command::add_option(const std::string& names, std::vector<unsigned long>& values,
                           const std::string& description) {
  return option(*known_->add_option(names, values, description));
}

option command::add_option(const std::string& names, std::vector<unsigned long long>& values,
                           const std::string& description) {
  return option(*known_->add_option(names, values, description));
}

option command::add_option(const std::string& names, std::vector<double>& values, const std::string& description) {
  return option(*known_->add_option(names, values, description));
}

option command::add_option(const std::string& names, std::pair<int, int>& values, const std::string& description) {
  return option(*known_->add_option(names, values, description));
}

option command::add_choice(const std::string& names, std::function<void(int)> choose,
                           std::initializer_list<std::pair<const char*, int>> words, const std::string& description) {
  std::map<std::string, word_number> numbers;
  std::string all;
  for (const auto& [word, number] : words) {
    numbers.emplace(word, word_number{number});
    all += (all.empty() ? "" : ",") + std::string(word);
  }
  auto* added = known_->add_option_function<word_number>(
      names, [choose = std::move(choose)](const word_number& number) { choose(static_cast<int>(number)); },
      description);
  added->transform(CLI::CheckedTransformer(numbers, CLI::ignore_case).description('{' + all + '}'));
  return option(*added);
}

option command::add_flag(const std::string& names, bool& value, const std::string& description) {
  return option(*known_->add_flag(names, value, description));
}

void command::callback(std::function<void()> work) {
  known_->callback([work = std::move(work), files = files_, extended = extended_] {
    files->require_writable();
    extended ? extended->around(work) : work();
  });
}

std::size_t command::count(const std::string& name) const { return known_->count(name); }

// ---- files ---------------------------------------------------------------------------------------------------------

namespace {

declared_files::paths paths_in(const std::filesystem::path& value) {
  return [&value] { return std::vector{value}; };
}

declared_files::paths paths_in(const std::vector<std::filesystem::path>& values) {
  return [&values] { return values; };
}

std::vector<std::string> strings(std::initializer_list<const char*> words) { return {words.begin(), words.end()}; }

/// Returns the extensions; without .exr in a build without OpenEXR.
std::vector<std::string> offered(std::initializer_list<const char*> extensions) {
  std::vector<std::string> all = strings(extensions);
  if (!has_exr) std::erase(all, ".exr");
  return all;
}

}  // namespace

option command::add_input(const std::string& names, std::filesystem::path& value, const std::string& description) {
  auto* added = known_->add_option(names, value, description);
  files_->add_input(added->get_name(), paths_in(value));
  return option(*added);
}

option command::add_input(const std::string& names, std::vector<std::filesystem::path>& values,
                          const std::string& description) {
  auto* added = known_->add_option(names, values, description);
  files_->add_input(added->get_name(), paths_in(values));
  return option(*added);
}

option command::add_input(const std::string& names, std::vector<std::pair<std::string, std::string>>& values,
                          const std::string& description) {
  auto* added = known_->add_option(names, values, description);
  files_->add_input(added->get_name(), [&values] {
    std::vector<std::filesystem::path> all;
    for (const auto& [first, second] : values) all.insert(all.end(), {first, second});
    return all;
  });
  return option(*added);
}

option command::add_input_folder(const std::string& names, std::filesystem::path& value,
                                 std::initializer_list<const char*> extensions, const std::string& description) {
  auto* added = known_->add_option(names, value, description);
  files_->add_input_folder(added->get_name(), paths_in(value), strings(extensions));
  return option(*added);
}

option command::add_input_folders(const std::string& names, std::vector<std::filesystem::path>& values,
                                  std::initializer_list<const char*> extensions, const std::string& description) {
  auto* added = known_->add_option(names, values, description);
  files_->add_input_folder(added->get_name(), paths_in(values), strings(extensions));
  return option(*added);
}

option command::add_output(const std::string& names, std::filesystem::path& value,
                           std::initializer_list<const char*> extensions, const std::string& description) {
  auto* added = known_->add_option(names, value, description);
  files_->add_output(added->get_name(), paths_in(value), offered(extensions));
  return option(*added);
}

option command::add_output_folder(const std::string& names, std::filesystem::path& value,
                                  std::initializer_list<const char*> files, const std::string& description) {
  auto* added = known_->add_option(names, value, description);
  files_->add_output_folder(added->get_name(), paths_in(value), strings(files));
  return option(*added);
}

void command::require_writable(const std::filesystem::path& derived) const { files_->require_writable(derived); }

// ---- groups --------------------------------------------------------------------------------------------------------

void option_group::require_option(std::size_t number) { known().require_option(static_cast<int>(number)); }
void option_group::require_option(std::size_t least, std::size_t most) { known().require_option(least, most); }

// ---- the program ---------------------------------------------------------------------------------------------------

namespace {

extern "C" void end_by_signal(int signal) {
  gonio::io::remove_unfinished_files();
  ::raise(signal);  // the default action is restored
}

/// Removes half-written files if a signal ends the program.
void clean_up_on_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction known {};
    if (::sigaction(signal, nullptr, &known) != 0 || known.sa_handler != SIG_DFL) continue;  // nohup ignores SIGHUP
    known = {};
    known.sa_handler = end_by_signal;
    known.sa_flags = static_cast<int>(SA_RESETHAND | SA_NODEFER);
    ::sigaction(signal, &known, nullptr);
  }
}

/// Ignores the signal at the limit of file size (ulimit -f): writing then fails with a message, as on a full disk.
void go_on_at_size_limits() { ::signal(SIGXFSZ, SIG_IGN); }

/// Returns the option names of a subcommand and of its groups, such as --output and -o.
std::vector<std::string> option_names(const CLI::App& known) {
  std::vector<std::string> names;
  for (const CLI::Option* each : known.get_options()) {
    for (const std::string& name : each->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : each->get_snames()) names.push_back("-" + name);
  }
  for (const CLI::App* group : known.get_subcommands(nullptr))
    if (group->get_name().empty())
      for (std::string& name : option_names(*group)) names.push_back(std::move(name));
  return names;
}

std::vector<std::string> subcommand_names(const CLI::App& known) {
  std::vector<std::string> names;
  for (const CLI::App* each : known.get_subcommands(nullptr))
    if (!each->get_name().empty()) names.push_back(each->get_name());
  return names;
}

/// Returns the name of the program or a subcommand with its parents, such as `gonio lab scan`.
std::string path_of(const CLI::App& at) {
  return at.get_parent() == nullptr ? at.get_name() : path_of(*at.get_parent()) + " " + at.get_name();
}

/// Returns the innermost subcommand that was called.
const CLI::App& called(const CLI::App& all) {
  const std::vector<CLI::App*> below = all.get_subcommands();
  return below.empty() ? all : called(*below.front());
}

/// Does the word look like --output or -o? -1 is a number.
bool is_option(const std::string& word) {
  return word.starts_with("--") ||
         (word.size() == 2 && word[0] == '-' && std::isalpha(static_cast<unsigned char>(word[1])) != 0);
}

/// Returns a sentence on the first word that is not a subcommand or option in its position, and suggests the nearest
/// known word; empty if all words are known.
std::string unknown_word(const CLI::App& all, int argc, char** argv) {
  const CLI::App* at = &all;
  const auto sentence = [&](const std::string& word, const char* kind, const std::vector<std::string>& known) {
    const std::string path = path_of(*at);
    const auto meant = gonio::nearest_word(word, known);
    return "'" + word + "' is no " + kind + " of " + path +
           (meant ? ": did you mean " + *meant + "?" : " (" + path + " --help lists them)");
  };
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i], name = word.substr(0, word.find('='));
    if (word == "--") return "";
    if (is_option(name)) {
      const std::vector<std::string> known = option_names(*at);
      if (std::ranges::find(known, name) == known.end()) return sentence(name, "option", known);
    } else if (const auto known = subcommand_names(*at); !known.empty() && !word.starts_with('-')) {
      if (std::ranges::find(known, word) == known.end()) return sentence(word, "subcommand", known);
      at = at->get_subcommand(word);
    }
  }
  return "";
}

}  // namespace

program::program(const std::string& name, const std::string& description, const std::string& version)
    : program(name, std::make_unique<CLI::App>(description, name)) {
  all_->formatter(std::make_shared<help_formatter>());
  all_->set_help_all_flag("--help-all", "Print this help with all options, and exit");
  all_->set_version_flag("--version", version);
  require_subcommand();
}

program::program(std::string name, std::unique_ptr<CLI::App> all)
    : command(*all, std::make_shared<declared_files>()), name_(std::move(name)), all_(std::move(all)) {}

program::~program() = default;

int program::run(int argc, char** argv) {
  const auto complain = [&](const std::string& what, int code) {
    std::cerr << name_ << ": " << gonio::printable(what) << '\n';
    return code;
  };
  clean_up_on_signals();
  go_on_at_size_limits();
  if (argc == 1 && !greeting_.empty()) {
    std::cout << greeting_ << '\n';
    return 0;
  }
  try {
    all_->parse(argc, argv);
    return 0;
  } catch (const negative_answer&) {
    return no;
  } catch (const CLI::Success& request) {  // --help and --version
    return all_->exit(request);
  } catch (const CLI::ParseError& error) {
    const std::string unknown = unknown_word(*all_, argc, argv);
    if (!unknown.empty()) return complain(unknown, bad_input);
    return complain(std::string(error.what()) + " (" + path_of(called(*all_)) + " --help shows the usage)", bad_input);
  } catch (const gonio::error& error) {
    return complain(error.what(), bad_input);
  } catch (const std::bad_alloc&) {
    return complain("there is not enough memory", failure);
  } catch (const std::exception& error) {
    return complain(error.what(), failure);
  }
}

}  // namespace cli
