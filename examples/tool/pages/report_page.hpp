#pragma once
/// The pages of `gonio report` and of `--report` of other commands: one file, which a browser shows without network
/// access. Its parts are in examples/report/ and are compiled in.

#include "tool/files/json.hpp"
#include "tool/options/command.hpp"

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace cli {

/// Escapes text for the content of HTML tags, or for a quoted attribute.
[[nodiscard]] std::string escape_html(std::string_view text);

/// Escapes JSON for a script in HTML: every `<` becomes `\u003c`, so no text ends the script. The parsed JSON is the
/// same.
[[nodiscard]] std::string escape_script(std::string_view json_text);

/// Returns the whole page. examples/report/report.js draws `data`; its `kind` names the command.
[[nodiscard]] std::string report_page(const std::string& title, const json& data);

/// The page that a command writes, and the command line, which the page repeats.
struct page_option {
  std::filesystem::path path;
  std::vector<std::string> command_line;  ///< its first word is the program

  [[nodiscard]] bool is_given() const noexcept { return !path.empty(); }
};

/// Adds `--report` to a command that writes a page beside its other results.
void add_report_option(command& to, page_option& page, const std::vector<std::string>& command_line);

/// Returns the record of a command: pairs of a name and a text; pairs with an empty text are left out.
[[nodiscard]] json record_of(std::initializer_list<std::pair<const char*, std::string>> pairs);

/// Writes a page to a file beside its target, and then renames the file. The page's title is the `name` of the data;
/// its `record` begins with the command and the version.
void write_report_page(const page_option& page, json data);

}  // namespace cli
