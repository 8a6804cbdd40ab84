/// Scans. A reading whose checksum is a question mark gets the right one.

#include "harness.hpp"
#include <gonio/io/scan_journal.hpp>

namespace {

/// Fuzzers do not find a CRC-32.
std::string with_checksums(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(char{10}), text.size());
    const std::string_view line = text.substr(0, end);
    if (line.starts_with("reading") && line.ends_with(" ?"))
      result += gonio::io::detail::with_checksum(std::string(line.substr(0, line.size() - 2)));
    else
      result += std::string(text.substr(0, end + 1));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return result;
}

void read(fuzz::input bytes) {
  static_cast<void>(gonio::io::parse_scan(with_checksums(fuzz::text_of(bytes)), fuzz::bytes_name));
}

const fuzz::registered harness("scan_journal", &read);

}  // namespace
