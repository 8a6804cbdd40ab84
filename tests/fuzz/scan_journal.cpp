/// Scans. Where a checksum should be, a question mark gets the right one, which fuzzers do not find.

#include "harness.hpp"
#include <gonio/io/measurements/scan_journal.hpp>

#include <zlib.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace {

[[nodiscard]] std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

[[nodiscard]] unsigned long checksum_of(std::string_view text) {
  return crc32_z(0, reinterpret_cast<const Bytef*>(text.data()), text.size());
}

std::string with_checksums(std::string_view text) {
  const std::vector<std::string> lines = lines_of(text);
  std::string poses, result;
  for (const std::string& line : lines)
    if (line.starts_with("pose")) poses += line + '\n';
  for (const std::string& line : lines) {
    constexpr std::string_view setup = "setup ? ";
    if (line.starts_with("reading") && line.ends_with(" ?"))
      result += gonio::io::detail::with_checksum(line.substr(0, line.size() - 2));
    else if (line.starts_with(setup))
      result += "setup " + std::to_string(checksum_of(std::string_view(line).substr(setup.size()))) + ' ' +
                line.substr(setup.size()) + '\n';
    else if (line.starts_with("plan") && line.ends_with(" ?"))
      result += line.substr(0, line.size() - 1) + std::to_string(checksum_of(poses)) + '\n';
    else
      result += line + '\n';
  }
  if (!text.ends_with('\n') && !result.empty()) result.pop_back();
  return result;
}

void read(fuzz::input bytes) {
  static_cast<void>(gonio::io::read_scan(with_checksums(fuzz::text_of(bytes)), fuzz::bytes_name));
}

const fuzz::registered harness("scan_journal", &read);

}  // namespace
