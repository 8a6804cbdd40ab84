#pragma once
/// The pages of `gonio report` and of `--report` of other commands: one file, which a browser shows without asking any
/// network. Its parts stand in examples/report/ and are compiled in.

#include "command.hpp"
#include "json.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cli {

/// Text between the tags of HTML, or in a quoted attribute.
[[nodiscard]] std::string escape_html(std::string_view text);

/// JSON in a script of HTML: `</` becomes `<\/` and `<!` becomes `\u003c!`, so that no text in it ends the script.
/// What is read of it is the same.
[[nodiscard]] std::string escape_script(std::string_view json_text);

/// Bytes as text (RFC 4648).
[[nodiscard]] std::string base64(std::span<const std::byte> bytes);

/// Bytes as a URL that holds them in base64 (RFC 2397).
[[nodiscard]] std::string data_url(std::string_view media_type, std::span<const std::byte> bytes);

/// The whole page. `data` is what examples/report/report.js draws; its `kind` says of which command.
[[nodiscard]] std::string report_page(const std::string& title, const json& data);

/// Writes the page that is called by `name` of the data beside its target and renames it.
void write_report_page(const std::filesystem::path& path, const json& data);

/// The command line as a shell takes it; its first word is the program.
[[nodiscard]] std::string as_typed(const std::vector<std::string>& words);

/// What was done, as the pairs of a name and a text that a page ends with: first the command and the version.
[[nodiscard]] json record_of_command(const std::vector<std::string>& words);
/// Adds a pair, unless its text is empty.
void add_to_record(json& record, const std::string& name, const std::string& text);

/// The option of commands that write a page beside their other results.
void add_report_option(command& to, std::filesystem::path& page);

}  // namespace cli
