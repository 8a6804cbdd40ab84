#pragma once
/// The record of a scan on disk, which survives any end of the process: readings are appended one by one, and each is
/// on the disk before the machine moves on. Text; docs/reference/formats.md describes the lines. POSIX.

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

/// The sample and the conditions of a scan. Scans that differ in one of these are different scans.
struct scan_subject {
  std::string sample;          ///< the sample in the machine: a line of text
  std::uint32_t checksum = 0;  ///< CRC-32 of the sample's file (simulation) or of the list of frames; otherwise 0
  std::string setup;           ///< the machine and its options: a line of text
  std::uint64_t seed = 0;      ///< of the random numbers of a simulation
};

/// Returns the CRC-32 of a file, for scan_subject. Detects files that were mixed up, not forgeries.
[[nodiscard]] std::uint32_t checksum_of_file(const std::filesystem::path& path);

/// A scan, complete or not.
struct recorded_scan {
  std::optional<scan_subject> subject;  ///< none if the file's version did not record it
  std::uint16_t largest_count = 0;
  std::vector<direction_pair> poses;                      ///< the plan's, then those added during the scan
  std::size_t planned = 0;                                ///< number of poses in the plan
  std::vector<std::optional<capture::reading>> readings;  ///< one for each pose

  [[nodiscard]] std::size_t measured() const {
    return static_cast<std::size_t>(std::ranges::count_if(readings, [](const auto& each) { return each.has_value(); }));
  }
};

namespace detail {

/// Returns a line's fields followed by the CRC-32 of their text, to detect a truncated or damaged line.
[[nodiscard]] std::string with_checksum(std::string fields);

[[nodiscard]] bool has_checksum(std::string_view line);

[[nodiscard]] std::string write_pose(const direction_pair& pose);
[[nodiscard]] std::string write_added_pose(const direction_pair& pose);
/// Returns the lines of a scan's file above its readings. Throws gonio::error unless each text of the subject is one
/// line.
[[nodiscard]] std::string write_scan_header(const scan_subject& subject, std::span<const direction_pair> poses,
                                            std::uint16_t largest_count);

[[nodiscard]] std::string write_reading(std::size_t pose, const capture::reading& taken);

/// Reads the numbers of a line one after the other.
class number_reader {
 public:
  number_reader(const text_rule& rule, const text_position& position) : rule_(rule), position_(position) {}

  double next();
  std::size_t next_whole(double most, const std::string& what);
  [[nodiscard]] std::size_t left() const noexcept { return rule_.numbers.size() - used_; }

 private:
  const text_rule& rule_;
  const text_position& position_;
  std::size_t used_ = 0;
};

[[nodiscard]] capture::reading read_reading(number_reader& numbers, std::uint16_t largest_count,
                                            const text_position& position);

/// Reads a pose of the plan (`numbers` is 6), or one added later (7: the last is a checksum).
[[nodiscard]] direction_pair read_pose(const text_rule& rule, std::size_t numbers, const text_position& position);

/// The content of the lines read so far.
struct scan_lines {
  bool has_sample = false, has_setup = false, has_seed = false, has_reading = false;
  scan_subject subject;
  std::optional<std::pair<std::size_t, std::uint32_t>> plan;  ///< number of poses, and the CRC-32 of their lines
  std::string pose_lines;
};

/// Reads a line of the subject: a name, a number and, except for the seed, a text. Returns false for any other line.
[[nodiscard]] bool apply_subject_line(std::string_view line, const text_position& position, scan_lines& before);
void apply_scan_line(std::string_view line, const text_position& position, recorded_scan& scan, scan_lines& before);
/// Checks the header lines when all lines have been read, and completes the scan.
void finish_scan(recorded_scan& scan, const scan_lines& all, const std::string& name);

/// Returns the text without a last line that is incomplete or has a wrong checksum: a killed process or a power failure
/// may leave one.
[[nodiscard]] std::string_view whole_lines(std::string_view text);

}  // namespace detail

/// Reads a scan, complete or not, from the text of its file; ignores a last line that is incomplete or has a wrong
/// checksum. Throws gonio::error naming any other line that is damaged or invalid. Errors call the file `name`.
[[nodiscard]] recorded_scan read_scan(std::string_view text, const std::string& name);

/// Reads a scan's file.
[[nodiscard]] recorded_scan read_scan(const std::filesystem::path& path);

/// A `capture::scan_record` in a file. Only one process can have the file open.
class scan_journal {
 public:
  /// Resumes a scan, or begins it if there is no such file. Throws gonio::error, leaving the file unchanged, if it has
  /// another subject or none, other poses or another camera, is damaged, cannot be written, or is open elsewhere.
  scan_journal(const std::filesystem::path& path, const scan_subject& subject, std::span<const direction_pair> poses,
               std::uint16_t largest_count);

  [[nodiscard]] bool has(std::size_t pose) const { return scan_.readings.at(pose).has_value(); }
  [[nodiscard]] const recorded_scan& scan() const noexcept { return scan_; }

  /// Returns when the reading is on the disk. Throws gonio::error if the reading cannot be written or the pose already
  /// has a reading.
  void add(std::size_t pose, const capture::reading& taken);

  /// Adds a pose after all others, for a scan that chooses poses by its readings. Returns when the pose is on the disk.
  /// Throws gonio::error if the pose cannot be written or is not above the horizon.
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
