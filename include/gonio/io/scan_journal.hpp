#pragma once
/// The record of a scan on disk, which survives whatever ends the process: readings are appended one by one and are on
/// the disk before the machine moves on. Text; docs/formats.md has the lines. POSIX.

#include <gonio/capture/device.hpp>
#include <gonio/capture/scan.hpp>
#include <gonio/io/rules.hpp>

#include <sys/file.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::io {

/// A scan as far as it has come.
struct recorded_scan {
  std::uint16_t largest_count = 0;
  std::vector<direction_pair> poses;
  std::vector<std::optional<reading>> readings;  ///< one for each pose

  [[nodiscard]] std::size_t measured() const {
    return static_cast<std::size_t>(std::ranges::count_if(readings, [](const auto& each) { return each.has_value(); }));
  }
};

namespace detail {

/// A line's fields followed by the CRC-32 of their text: a line that was cut short, or damaged, does not have it.
[[nodiscard]] std::string with_checksum(std::string fields);

[[nodiscard]] bool has_checksum(std::string_view line);

[[nodiscard]] std::string format_scan_header(std::span<const direction_pair> poses, std::uint16_t largest_count);

[[nodiscard]] std::string format_reading(std::size_t pose, const reading& taken);

/// Takes a line's numbers one after the other.
class number_reader {
 public:
  number_reader(const text_rule& rule, const text_place& place) : rule_(rule), place_(place) {}

  double next();
  std::size_t next_whole(double most, const std::string& what);
  [[nodiscard]] std::size_t left() const noexcept { return rule_.numbers.size() - used_; }

 private:
  const text_rule& rule_;
  const text_place& place_;
  std::size_t used_ = 0;
};

[[nodiscard]] reading parse_reading(number_reader& numbers, std::uint16_t largest_count, const text_place& place);

[[nodiscard]] direction_pair parse_pose(const text_rule& rule, const text_place& place);

/// `has_reading`: was there one in a line before?
void apply_scan_line(std::string_view line, const text_place& place, recorded_scan& scan, bool& has_reading);

/// The text without what a process that was killed, or a machine that lost its power, left of the last line.
[[nodiscard]] std::string_view whole_lines(std::string_view text);

}  // namespace detail

/// Throws gonio::error naming the line that is damaged or not what it should be; a last line that is not whole is left
/// out. `name` is what errors call the text.
[[nodiscard]] recorded_scan parse_scan(std::string_view text, const std::string& name);

/// Reads a scan, whole or not. Throws gonio::error naming the file and the line.
[[nodiscard]] recorded_scan read_scan(const std::filesystem::path& path);

/// A scan's record in a file: a scan_record. One process at a time can have it open.
class scan_journal {
 public:
  /// Goes on with a scan, or begins it if there is no such file. Throws gonio::error if the file is one of other poses
  /// or of another camera, is damaged, cannot be written, or is open in another process.
  scan_journal(const std::filesystem::path& path, std::span<const direction_pair> poses, std::uint16_t largest_count);

  [[nodiscard]] bool has(std::size_t pose) const { return scan_.readings.at(pose).has_value(); }
  [[nodiscard]] const recorded_scan& scan() const noexcept { return scan_; }

  /// Returns when the reading is on the disk. Throws gonio::error if it cannot be written, or is there already.
  void add(std::size_t pose, const reading& taken);

 private:
  void open();

  void require_same(std::span<const direction_pair> poses, std::uint16_t largest_count) const;

  [[noreturn]] void fail() const { detail::refuse_file(path_, "cannot be written: " + detail::system_reason(errno)); }

  std::filesystem::path path_;
  detail::descriptor file_;
  recorded_scan scan_;
};

static_assert(scan_record<scan_journal>);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/impl/scan_journal.ipp>
#endif
