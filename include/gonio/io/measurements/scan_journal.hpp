#pragma once
/// The record of a scan on disk, which survives whatever ends the process: readings are appended one by one and are on
/// the disk before the machine moves on. Text; docs/reference/formats.md has the lines. POSIX.

#include <gonio/capture/device.hpp>
#include <gonio/capture/scan.hpp>
#include <gonio/io/text/rules.hpp>

#include <sys/file.h>

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

/// What a scan measures, and how: two scans of which one of these differs are not the same.
struct scan_subject {
  std::string sample;          ///< what lies in the machine: a line of text
  std::uint32_t checksum = 0;  ///< CRC-32 of the file that it is simulated by, or of the list of its frames; else 0
  std::string setup;           ///< the machine and its options: a line of text
  std::uint64_t seed = 0;      ///< of what is random in a simulation
};

/// The CRC-32 of a file's bytes, for scan_subject. It tells files apart that were mistaken for one another, not forged.
[[nodiscard]] std::uint32_t checksum_of_file(const std::filesystem::path& path);

/// A scan as far as it has come.
struct recorded_scan {
  std::optional<scan_subject> subject;  ///< none if the file is by a version that did not write it down
  std::uint16_t largest_count = 0;
  std::vector<direction_pair> poses;  ///< those of the plan, then those that were added while it was measured
  std::size_t planned = 0;            ///< how many of them are the plan's
  std::vector<std::optional<capture::reading>> readings;  ///< one for each pose

  [[nodiscard]] std::size_t measured() const {
    return static_cast<std::size_t>(std::ranges::count_if(readings, [](const auto& each) { return each.has_value(); }));
  }
};

namespace detail {

/// A line's fields followed by the CRC-32 of their text: a line that was cut short, or damaged, does not have it.
[[nodiscard]] std::string with_checksum(std::string fields);

[[nodiscard]] bool has_checksum(std::string_view line);

[[nodiscard]] std::string write_pose(const direction_pair& pose);
[[nodiscard]] std::string write_added_pose(const direction_pair& pose);
/// Throws gonio::error if a text of the subject is not one line.
[[nodiscard]] std::string write_scan_header(const scan_subject& subject, std::span<const direction_pair> poses,
                                            std::uint16_t largest_count);

[[nodiscard]] std::string write_reading(std::size_t pose, const capture::reading& taken);

/// Reads a line's numbers one after the other.
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

[[nodiscard]] capture::reading read_reading(number_reader& numbers, std::uint16_t largest_count,
                                            const text_place& place);

/// A pose of the plan, or, with a checksum behind its six numbers, one that was added.
[[nodiscard]] direction_pair read_pose(const text_rule& rule, std::size_t numbers, const text_place& place);

/// What a reader of lines knows of those before.
struct scan_lines {
  bool has_sample = false, has_setup = false, has_seed = false, has_reading = false;
  scan_subject subject;
  std::optional<std::pair<std::size_t, std::uint32_t>> plan;  ///< how many poses, and the CRC-32 of their lines
  std::string pose_lines;
};

/// A line of the subject: a name, a number and, but for the seed, a text. False if it is another one.
[[nodiscard]] bool apply_subject_line(std::string_view line, const text_place& place, scan_lines& before);
void apply_scan_line(std::string_view line, const text_place& place, recorded_scan& scan, scan_lines& before);
/// What can be said of the head when all lines are read.
void finish_scan(recorded_scan& scan, const scan_lines& all, const std::string& name);

/// The text without what a process that was killed, or a machine that lost its power, left of the last line.
[[nodiscard]] std::string_view whole_lines(std::string_view text);

}  // namespace detail

/// Throws gonio::error naming the line that is damaged or not what it should be; a last line that is not whole is left
/// out. `name` is what errors call the text.
[[nodiscard]] recorded_scan read_scan(std::string_view text, const std::string& name);

/// Reads a scan, whole or not. Throws gonio::error naming the file and the line.
[[nodiscard]] recorded_scan read_scan(const std::filesystem::path& path);

/// A scan's record in a file: a scan_record. One process at a time can have it open.
class scan_journal {
 public:
  /// Goes on with a scan, or begins it if there is no such file. Throws gonio::error if the file is one of another
  /// subject, of other poses or of another camera, or does not say of which subject; is damaged; cannot be written; or
  /// is open in another process. It is then as it was.
  scan_journal(const std::filesystem::path& path, const scan_subject& subject, std::span<const direction_pair> poses,
               std::uint16_t largest_count);

  [[nodiscard]] bool has(std::size_t pose) const { return scan_.readings.at(pose).has_value(); }
  [[nodiscard]] const recorded_scan& scan() const noexcept { return scan_; }

  /// Returns when the reading is on the disk. Throws gonio::error if it cannot be written, or is there already.
  void add(std::size_t pose, const capture::reading& taken);

  /// One more pose to measure, behind all others: an adaptive scan chooses it by what was read. Returns when it is on
  /// the disk. Throws gonio::error if it cannot be written, or is not above the horizon.
  void add_pose(const direction_pair& pose);

 private:
  void open();
  void write(std::string_view text);
  void require_same(const scan_subject& subject, std::span<const direction_pair> poses,
                    std::uint16_t largest_count) const;

  [[noreturn]] void fail() const { refuse_file(path_, "cannot be written: " + system_reason(errno)); }

  std::filesystem::path path_;
  descriptor file_;
  recorded_scan scan_;
};

static_assert(capture::scan_record<scan_journal>);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/scan_journal.ipp>
#endif
