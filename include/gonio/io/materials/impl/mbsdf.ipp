#pragma once
/// Bodies of io/materials/mbsdf.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/byte_stream.hpp>
#include <gonio/io/materials/mbsdf.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::io::detail {

inline constexpr std::string_view mbsdf_magic = "NVIDIA ARC MBSDF V1\n";
inline constexpr std::string_view mbsdf_reflection = "MBSDF_DATA_REFLECTION=", mbsdf_either = "MBSDF_DATA=";
inline constexpr std::string_view mbsdf_transmission = "MBSDF_DATA_TRANSMISSION=";

/// Returns a text in quotes, with a backslash before each quote and backslash, and \n for a line feed.
[[nodiscard]] inline std::string mbsdf_quoted(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    if (c == '\n')
      quoted += "\\n";
    else
      quoted += c < ' ' || c > '~' ? '?' : c;
  }
  return quoted + '"';
}

[[nodiscard]] inline std::string mbsdf_unquoted(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool escaped = text[i] == '\\' && i + 1 < text.size();
    if (escaped) ++i;
    plain += escaped && text[i] == 'n' ? '\n' : text[i];
  }
  return plain;
}

/// Reads a file block by block.
class mbsdf_reader {
 public:
  mbsdf_reader(std::span<const std::byte> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  [[nodiscard]] mbsdf_material read() {
    if (!text().starts_with(mbsdf_magic))
      refuse({name_, ": does not start with 'NVIDIA ARC MBSDF V1', expected a measured BSDF of MDL"});
    bytes_ = bytes_.subspan(mbsdf_magic.size());
    mbsdf_metadata metadata;
    std::string_view line = next_line();
    for (; !begins_block(line); line = next_line()) read_entry(line, metadata);
    if (line == mbsdf_transmission) refuse({name_, ": has only transmission, expected reflection"});
    model::polar_grid_brdf reflection = read_block();
    const bool more = !bytes_.empty();
    if (more && next_line() != mbsdf_transmission)
      refuse({name_, ": after the reflection expected MBSDF_DATA_TRANSMISSION= or the end of the file"});
    if (more) static_cast<void>(read_block());
    if (!bytes_.empty()) refuse({name_, ": has ", bytes_.size(), " bytes after its last value"});
    return {std::move(reflection), std::move(metadata), more};
  }

 private:
  [[nodiscard]] static bool begins_block(std::string_view line) {
    return line == mbsdf_reflection || line == mbsdf_either || line == mbsdf_transmission;
  }

  [[nodiscard]] std::string_view text() const { return {reinterpret_cast<const char*>(bytes_.data()), bytes_.size()}; }

  [[nodiscard]] std::string_view next_line() {
    const std::string_view left = text();
    const std::size_t end = left.find('\n');
    if (end == std::string_view::npos) refuse({name_, ": has no line MBSDF_DATA_REFLECTION=, expected reflection"});
    bytes_ = bytes_.subspan(end + 1);
    return left.substr(0, end);
  }

  /// Reads a line key="value"; ignores any other line.
  static void read_entry(std::string_view line, mbsdf_metadata& metadata) {
    const std::size_t middle = line.find("=\"");
    if (middle == std::string_view::npos || line.size() < middle + 3 || !line.ends_with('"')) return;
    metadata.emplace(line.substr(0, middle), mbsdf_unquoted(line.substr(middle + 2, line.size() - middle - 3)));
  }

  [[nodiscard]] model::polar_grid_brdf read_block() {
    byte_reader reader(bytes_, name_);
    const auto type = reader.read<std::uint32_t>();
    const std::uint64_t polar = reader.read<std::uint32_t>(), azimuth = reader.read<std::uint32_t>();
    if (type > 1) refuse({name_, ": has values of the unknown type ", type, ", expected 0 or 1"});
    if (polar == 0 || azimuth == 0) refuse({name_, ": has no cells of theta or of phi"});
    const std::uint64_t most = reader.left() / sizeof(float) / (type == 0 ? 1 : 3);
    if (polar > most / polar || azimuth > most / (polar * polar))
      refuse({name_, ": the file is truncated or its counts are wrong: ", polar, " x ", polar, " x ", azimuth,
              " cells are declared"});
    const std::uint64_t count = polar * polar * azimuth * (type == 0 ? 1 : 3);
    std::vector<float> values = reader.read_all<float>(count);
    bytes_ = bytes_.last(reader.left());
    if (const auto wrong = std::ranges::find_if_not(values, [](float value) { return std::isfinite(value); });
        wrong != values.end())
      refuse({name_, ": value ", wrong - values.begin(), " is not finite"});
    return {{static_cast<Eigen::Index>(polar), static_cast<Eigen::Index>(azimuth)}, std::move(values)};
  }

  std::span<const std::byte> bytes_;
  const std::string& name_;
};

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE mbsdf_material read_mbsdf(std::span<const std::byte> bytes, const std::string& name) {
  return detail::mbsdf_reader(bytes, name).read();
}

GONIO_INLINE std::vector<std::byte> write_mbsdf(const mbsdf_material& material) {
  const auto is_word = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  std::string head(detail::mbsdf_magic);
  for (const auto& [key, value] : material.metadata) {
    if (key.empty() || !std::ranges::all_of(key, is_word))
      gonio::refuse({"a key of a .mbsdf file needs letters, digits and underscores, not '", key, "'"});
    head += message_of({key, "=", detail::mbsdf_quoted(value), "\n"});
  }
  head += message_of({detail::mbsdf_reflection, "\n"});
  const model::polar_grid_brdf& f = material.reflection;
  byte_writer writer;
  writer.write_bytes(head.data(), head.size());
  writer.write(static_cast<std::uint32_t>(f.channels() == 1 ? 0 : 1));
  writer.write(static_cast<std::uint32_t>(f.grid().polar));
  writer.write(static_cast<std::uint32_t>(f.grid().azimuth));
  writer.write_all(f.values());
  return std::move(writer).bytes();
}

}  // namespace gonio::io
