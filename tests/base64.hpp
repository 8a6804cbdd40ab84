#pragma once
/// The inverse of gonio::io::base64.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

[[nodiscard]] inline std::vector<std::byte> from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::byte> bytes;
  std::uint32_t bits = 0;
  int known = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = (bits << 6) | static_cast<std::uint32_t>(digits.find(c));
    known += 6;
    if (known < 8) continue;
    known -= 8;
    bytes.push_back(static_cast<std::byte>((bits >> known) & 255U));
  }
  return bytes;
}
