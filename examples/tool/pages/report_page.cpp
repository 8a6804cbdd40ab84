#include "report_page.hpp"

#include "page_pdf.hpp"
#include "report_parts.hpp"
#include "tool/files/file_start.hpp"
#include <gonio/io/bytes/file.hpp>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <utility>

namespace cli {

namespace {

/// Replaces every `from` in a text by `to`.
std::string replaced(std::string_view text, std::string_view from, std::string_view to) {
  std::string result;
  std::size_t position = 0;
  while (true) {
    const std::size_t found = text.find(from, position);
    result.append(text.substr(position, found - position));
    if (found == std::string_view::npos) return result;
    result.append(to);
    position = found + from.size();
  }
}

/// Returns a command line quoted for a shell.
std::string as_typed(const std::vector<std::string>& words) {
  std::string line = "gonio";
  for (const std::string& word : std::span(words).subspan(std::min<std::size_t>(1, words.size())))
    line += ' ' + shell_word(word);
  return line;
}

std::string joined(std::span<const std::string_view> pieces) {
  std::string all;
  for (const std::string_view piece : pieces) all.append(piece);
  return all;
}

}  // namespace

std::string escape_html(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string escape_script(std::string_view json_text) { return replaced(json_text, "<", "\\u003c"); }

std::string report_page(const std::string& title, const json& data) {
  // Inserted text is not searched for further marks.
  const std::pair<std::string_view, std::string> parts[] = {{"@TITLE@", escape_html(title)},
                                                            {"@STYLE@", joined(report_style())},
                                                            {"@DATA@", escape_script(data.dump())},
                                                            {"@BUNDLE@", joined(report_bundle())},
                                                            {"@SCRIPT@", joined(report_script())}};
  const std::string form = joined(report_form());
  std::string page;
  std::size_t position = 0;
  for (const auto& [mark, text] : parts) {
    const std::size_t found = form.find(mark, position);
    if (found == std::string::npos) throw std::logic_error("examples/report/page.html lacks a mark");
    page.append(form, position, found - position).append(text);
    position = found + mark.size();
  }
  return page.append(form, position);
}

void add_report_option(command& to, page_option& page, const std::vector<std::string>& command_line) {
  to.add_output("--report", page.path, {".html"},
                "Page to write (.html): one file that a browser shows without a network");
  page.command_line = command_line;
}

json record_of(std::initializer_list<std::pair<const char*, std::string>> pairs) {
  json record = json::array();
  for (const auto& [name, text] : pairs)
    if (!text.empty()) record.push_back(json::array({name, text}));
  return record;
}

void write_report_page(const page_option& page, json data) {
  json record = record_of({{"Command", as_typed(page.command_line)}, {"Version", "gonio " GONIO_VERSION}});
  for (const json& pair : data["record"].elements()) record.push_back(pair);
  data["record"] = std::move(record);
  const std::string text = report_page(data["name"].text(), data);
  if (lower_extension(page.path) == ".pdf") return print_page(page.path, text);
  gonio::io::write_atomically(page.path, std::as_bytes(std::span(text)));
}

}  // namespace cli
