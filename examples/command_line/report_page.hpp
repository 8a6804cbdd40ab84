#pragma once
/// The page of `gonio report`: one file, which a browser shows without asking any network. Its parts stand in
/// examples/report/ and are compiled in.

#include "json.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

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

/// The whole page. `data` is what examples/report/report.js draws.
[[nodiscard]] std::string report_page(const std::string& title, const json& data);

}  // namespace cli
