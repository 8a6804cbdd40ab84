#pragma once
/// How `--help` looks. Only command.cpp includes this: it needs CLI11.

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstddef>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace cli {

/// CLI11's formatter with lines of at most 100 columns, an example above the options of each subcommand (CLI11's
/// footer), and groups of rarely used options that only --help-all prints.
class help_formatter : public CLI::Formatter {
 public:
  static constexpr const char* rare_options = "More options";

  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    if (mode != CLI::AppFormatMode::Sub) prints_all_ = mode == CLI::AppFormatMode::All;
    hides_ = is_hiding(app);
    return CLI::Formatter::make_help(app, std::move(name), mode);
  }

  std::string make_expanded(const CLI::App* app) const override {
    const bool is_group = app->get_name().empty();
    return is_group && is_hiding(app) && !prints_all_ ? "" : CLI::Formatter::make_expanded(app);
  }

  std::string make_group(std::string group, bool is_positional,
                         std::vector<const CLI::Option*> options) const override {
    if (group == rare_options && !prints_all_) return "";
    if (!hides_) std::erase_if(options, [](const CLI::Option* each) { return each->check_name("--help-all"); });
    return options.empty() ? "" : CLI::Formatter::make_group(std::move(group), is_positional, std::move(options));
  }

  std::string make_description(const CLI::App* app) const override {
    const std::string example = app->get_footer(), text = wrapped("", CLI::Formatter::make_description(app), 0) + '\n';
    return example.empty() ? text : text + "\n" + example + "\n\n";
  }

  std::string make_footer(const CLI::App* app) const override {
    return is_hiding(app) && !prints_all_ ? "gonio " + app->get_name() + " --help-all prints more options.\n" : "";
  }

  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    return described(make_option_name(option, is_positional) + make_option_opts(option), make_option_desc(option));
  }

  std::string make_subcommand(const CLI::App* app) const override {
    return described(app->get_display_name(true), app->get_description());
  }

 private:
  static constexpr std::size_t indent = 30, width = 100;

  static bool is_hiding(const CLI::App* app) {
    return !app->get_options([](const CLI::Option* each) { return each->get_group() == rare_options; }).empty();
  }

  /// Returns a name and, from a fixed column on, its description.
  static std::string described(const std::string& name, const std::string& description) {
    std::string text = "  " + name;
    if (text.size() + 2 > indent) text += '\n' + std::string(indent, ' ');
    text.resize(std::max(text.size(), indent), ' ');
    return wrapped(text, description, indent) + '\n';
  }

  /// Appends the description's words from a column on, and breaks lines between words.
  static std::string wrapped(std::string text, const std::string& description, std::size_t first) {
    std::istringstream words(description);
    std::size_t column = first;
    for (std::string word; words >> word;) {
      if (column > first && column + 1 + word.size() > width) {
        text += '\n' + std::string(first, ' ');
        column = first;
      }
      if (column > first) text += ' ';
      text += word;
      column += word.size() + (column > first ? 1 : 0);
    }
    return text;
  }

  // Members, because CLI11 does not pass them on to groups of options.
  mutable bool prints_all_ = false, hides_ = false;
};

}  // namespace cli
