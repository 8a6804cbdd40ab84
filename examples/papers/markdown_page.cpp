#include "papers/markdown_page.hpp"

#include "tool/pages/fixed.hpp"
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/io/bytes/file.hpp>

#include <array>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <optional>
#include <sstream>
#include <streambuf>

namespace papers {

namespace {

constexpr std::size_t line_width = 120;
constexpr std::size_t most_rows = 25;  // of a table that is not folded

/// Returns whether an argument names an option that does not change the output.
bool is_left_out(const std::string& argument) {
  const std::string name = argument.substr(0, argument.find('='));
  return name == "--markdown" || name == "--state" || name == "--threads";
}

/// Returns the last part of a path, and any other argument unchanged.
std::string without_folders(const std::string& argument) {
  std::string name = argument;
  while (name.size() > 1 && name.back() == '/') name.pop_back();
  return name.substr(name.rfind('/') + 1);
}

/// Returns the last value given for an option.
std::optional<std::string> value_of(const std::string& name, std::span<const std::string> arguments) {
  std::optional<std::string> value;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == name && i + 1 < arguments.size()) value = arguments[i + 1];
    if (arguments[i].starts_with(name + '=')) value = arguments[i].substr(name.size() + 1);
  }
  return value;
}

std::string read_text(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = gonio::io::read_bytes(path);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Wraps prose at 120 characters. Rows of tables, lists and indented lines stay unchanged.
std::string wrapped(const std::string& text) {
  std::string all;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const bool is_prose = !line.empty() && std::string_view("|-* ").find(line.front()) == std::string_view::npos;
    while (is_prose && line.size() > line_width) {
      const std::size_t space = line.rfind(' ', line_width);
      if (space == std::string::npos || space == 0) break;
      all += line.substr(0, space) + '\n';
      line.erase(0, space + 1);
    }
    all += line + '\n';
  }
  return all;
}

/// Returns the first three columns of a table's first line: "method, data, outliers, ...".
std::string column_names(const std::string& header) {
  std::string names;
  std::istringstream cells(header.substr(1));
  std::size_t count = 0;
  for (std::string cell; std::getline(cells, cell, '|') && count < 4;) {
    const std::size_t first = cell.find_first_not_of(' ');
    if (first == std::string::npos) continue;
    const std::string name = cell.substr(first, cell.find_last_not_of(' ') + 1 - first);
    names += (count == 0 ? "" : ", ") + (count < 3 ? name : "...");
    ++count;
  }
  return names;
}

/// Folds long tables: GitHub and the site show a line to click on.
std::string folded(const std::string& text) {
  std::string all;
  std::vector<std::string> table;
  const auto end_table = [&] {
    const bool is_long = table.size() > most_rows + 2;
    if (is_long)
      all += "<details markdown=\"1\">\n<summary>" + std::to_string(table.size() - 2) +
             " rows: " + column_names(table.front()) + "</summary>\n\n";
    for (const std::string& row : table) all += row + '\n';
    if (is_long) all += "\n</details>\n";
    table.clear();
  };
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('|')) {
      table.push_back(line);
      continue;
    }
    end_table();
    all += line + '\n';
  }
  end_table();
  return all;
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of('\n');
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of('\n') + 1 - first);
}

std::string today() {
  const std::chrono::year_month_day date(std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now()));
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%04d-%02u-%02u", static_cast<int>(date.year()),
                static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
  return text.data();
}

/// Returns " of an AMD EPYC": the processor's own name, if the system reports it.
std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name") && line.find(": ") != std::string::npos)
      return " of " + line.substr(line.find(": ") + 2);
  return {};
}

/// Forwards everything to another buffer, and keeps a copy.
class keeping_buffer : public std::streambuf {
 public:
  explicit keeping_buffer(std::streambuf& next) : next_(&next) {}
  [[nodiscard]] const std::string& kept() const noexcept { return kept_; }

 protected:
  int_type overflow(int_type character) override {
    if (traits_type::eq_int_type(character, traits_type::eof())) return traits_type::not_eof(character);
    kept_ += traits_type::to_char_type(character);
    return next_->sputc(traits_type::to_char_type(character));
  }
  std::streamsize xsputn(const char* text, std::streamsize size) override {
    kept_.append(text, size);
    return next_->sputn(text, size);
  }
  int sync() override { return next_->pubsync(); }

 private:
  std::streambuf* next_;
  std::string kept_;
};

/// Runs the work, and returns the text that it prints to standard output. The text also appears there.
std::string printed_by(const std::function<void()>& work) {
  keeping_buffer buffer(*std::cout.rdbuf());
  struct redirection {
    std::streambuf* before;
    ~redirection() { std::cout.rdbuf(before); }
  };
  const redirection restored{std::cout.rdbuf(&buffer)};
  work();
  return buffer.kept();
}

}  // namespace

std::string normalised_command(std::span<const std::string> arguments) {
  std::string command = "gonio-papers";
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (is_left_out(arguments[i])) {
      if (arguments[i].find('=') == std::string::npos) ++i;  // skip its value
    } else if (arguments[0] == "run" && arguments[i] == "--") {
      command.clear();
    } else {
      command += (command.empty() ? "" : " ") + without_folders(arguments[i]);
    }
  }
  return command;
}

std::string with_block(std::string_view page, const std::filesystem::path& path, const std::string& command,
                       const std::string& content) {
  const std::string begin = "<!-- " + command + " -->\n";
  const std::string end = "<!-- end of " + command.substr(0, command.find(' ')) + " -->";
  const auto line = [&](const std::string& wanted, std::size_t from) {
    std::size_t found = page.find(wanted, from);
    while (found != 0 && found != std::string_view::npos && page[found - 1] != '\n')
      found = page.find(wanted, found + 1);
    return found;
  };
  const std::size_t first = line(begin, 0);
  const std::size_t last = first == std::string_view::npos ? first : line(end, first);
  if (last == std::string_view::npos || line("<!-- end of ", first) != last)
    gonio::refuse("'" + path.string() + "' has no block for `" + command + "`, which starts with the line '" +
                  begin.substr(0, begin.size() - 1) + "' and ends with '" + end + "'");
  if (line(begin, first + 1) != std::string_view::npos)
    gonio::refuse("'" + path.string() + "' has more than one block for `" + command + "`");
  return std::string(page.substr(0, first + begin.size())) + content + std::string(page.substr(last));
}

markdown_page::markdown_page(int argc, char** argv, std::string version)
    : arguments_(argv + (argc > 0 ? 1 : 0), argv + argc), version_(std::move(version)) {}

void markdown_page::add_option(command& to) {
  to.add_output("--markdown", path_, {".md"},
                "Page in which the output replaces the block of this command (the block starts with <!-- COMMAND -->)");
}

std::string markdown_page::origin(double seconds) const {
  gonio::thread_count threads;
  if (const auto given = value_of("--threads", arguments_))
    std::from_chars(given->data(), given->data() + given->size(), threads.value);
  const unsigned used = threads.resolve();
  return "Printed on " + today() + " by `" + normalised_command(arguments_) + "`, gonio " + version_ + ", " +
         std::to_string(used) + (used == 1 ? " thread" : " threads") + processor() + ", in " +
         cli::fixed(seconds, seconds < 10.0 ? 1 : 0) + " s.";
}

void markdown_page::around(const std::function<void()>& work) const {
  if (path_.empty()) return work();
  const std::string command = normalised_command(arguments_);
  static_cast<void>(with_block(read_text(path_), path_, command, {}));

  const auto start = std::chrono::steady_clock::now();
  const std::string printed = printed_by(work);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  // Read the page again: it may have changed in the meantime.
  const std::string content = '\n' + folded(wrapped(trimmed(printed))) + '\n' + wrapped(origin(seconds));
  const std::string page = with_block(read_text(path_), path_, command, content);
  gonio::io::write_atomically(path_, std::as_bytes(std::span(page)));
}

}  // namespace papers
