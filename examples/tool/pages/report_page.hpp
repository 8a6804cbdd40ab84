#pragma once
/// The pages of `gonio report` and of `--report` of other commands: one file, which a browser shows without asking any
/// network. Its parts stand in examples/report/ and are compiled in.

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

/// Text between the tags of HTML, or in a quoted attribute.
[[nodiscard]] std::string escape_html(std::string_view text);

/// JSON in a script of HTML: `</` becomes `<\/` and `<!` becomes `\u003c!`, so that no text in it ends the script.
/// What is read of it is the same.
[[nodiscard]] std::string escape_script(std::string_view json_text);

/// The whole page. `data` is what examples/report/report.js draws; its `kind` says of which command.
[[nodiscard]] std::string report_page(const std::string& title, const json& data);

/// Where a command writes its page, and the command line, which the page repeats.
struct page_option {
  std::filesystem::path path;
  std::vector<std::string> command_line;  ///< its first word is the program

  [[nodiscard]] bool is_given() const noexcept { return !path.empty(); }
};

/// Adds `--report` to a command that writes a page beside its other results.
void add_report_option(command& to, page_option& page, const std::vector<std::string>& command_line);

/// What was done, as pairs of a name and a text; a pair whose text is empty is left out.
[[nodiscard]] json record_of(std::initializer_list<std::pair<const char*, std::string>> pairs);

/// Writes a page beside its target and renames it. Its title is the `name` of the data, and its `record` begins with
/// the command and the version.
void write_report_page(const page_option& page, json data);

}  // namespace cli
