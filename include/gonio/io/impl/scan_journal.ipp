#pragma once
/// Bodies of io/scan_journal.hpp.

#include <gonio/capture/device.hpp>
#include <gonio/capture/scan.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/io/rules.hpp>
#include <gonio/io/scan_journal.hpp>

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

namespace gonio::io::detail {

GONIO_INLINE std::string with_checksum(std::string fields) {
  const auto sum = crc32_z(0, reinterpret_cast<const unsigned char*>(fields.data()), fields.size());
  return fields + " " + std::to_string(sum) + "\n";
}

GONIO_INLINE bool has_checksum(std::string_view line) {
  const std::size_t last = line.find_last_of(' ');
  return last != std::string_view::npos && with_checksum(std::string(line.substr(0, last))) == std::string(line) + "\n";
}

GONIO_INLINE std::string format_scan_header(std::span<const direction_pair> poses, std::uint16_t largest_count) {
  std::string text = "# gonio scan: wi and wo of each pose; number, frames, times, pixels and counts of each reading\n";
  text += "largest_count " + std::to_string(largest_count) + "\n";
  for (const direction_pair& pose : poses) {
    text += "pose";
    for (const direction& w : {pose.wi, pose.wo})
      for (const double component : w) text += ' ' + shortest(component);
    text += '\n';
  }
  return text;
}

GONIO_INLINE std::string format_reading(std::size_t pose, const reading& taken) {
  std::string fields = "reading " + std::to_string(pose) + ' ' + std::to_string(taken.frames.size());
  for (const double time : taken.times) fields += ' ' + shortest(time);
  fields += ' ' + std::to_string(taken.frames.front().rows());
  for (const camera_frame& each : taken.frames)
    for (const std::uint16_t count : each.reshaped()) fields += ' ' + std::to_string(count);
  return with_checksum(std::move(fields));
}

GONIO_INLINE double number_reader::next() {
  if (used_ == rule_.numbers.size()) place_.refuse("ends after " + std::to_string(used_) + " numbers");
  return rule_.numbers[used_++];
}

GONIO_INLINE std::size_t number_reader::next_whole(double most, const std::string& what) {
  const double value = next();
  if (!(value >= 0.0 && value <= most && value == std::floor(value)))
    place_.refuse(what + " is " + shortest(value) + ", expected a whole number up to " + shortest(most));
  return static_cast<std::size_t>(value);
}

GONIO_INLINE reading parse_reading(number_reader& numbers, std::uint16_t largest_count, const text_place& place) {
  reading taken;
  const std::size_t frames = numbers.next_whole(1000, "the number of frames");
  for (std::size_t i = 0; i < frames; ++i) {
    taken.times.push_back(numbers.next());
    if (!(taken.times.back() > 0.0)) place.refuse("an exposure time must be positive");
  }
  const std::size_t pixels = numbers.next_whole(1e6, "the number of pixels");
  if (frames == 0 || pixels == 0) place.refuse("a reading needs a frame, and a frame a pixel");
  if (numbers.left() != frames * pixels * 3 + 1)  // and the checksum
    place.refuse("has " + std::to_string(numbers.left() - std::min<std::size_t>(numbers.left(), 1)) +
                 " counts, expected " + std::to_string(frames * pixels * 3));
  for (std::size_t i = 0; i < frames; ++i) {
    camera_frame each(static_cast<Eigen::Index>(pixels), 3);
    for (std::uint16_t& count : each.reshaped())
      count = static_cast<std::uint16_t>(numbers.next_whole(largest_count, "a count"));
    taken.frames.push_back(std::move(each));
  }
  return taken;
}

GONIO_INLINE direction_pair parse_pose(const text_rule& rule, const text_place& place) {
  require_numbers(rule, {6}, place);
  const direction_pair pose{direction::Map(rule.numbers.data()), direction::Map(rule.numbers.data() + 3)};
  for (const direction& w : {pose.wi, pose.wo})
    if (!(std::abs(w.norm() - 1.0) < 1e-6) || !(w.z() > 0.0))
      place.refuse("a pose is two unit vectors above the horizon");
  return pose;
}

GONIO_INLINE void apply_scan_line(std::string_view line, const text_place& place, recorded_scan& scan,
                                  bool& has_reading) {
  const text_rule rule = parse_rule(line, place);
  number_reader numbers(rule, place);
  if (rule.name == "largest_count") {
    require_numbers(rule, {1}, place);
    scan.largest_count = static_cast<std::uint16_t>(numbers.next_whole(65535, "the largest count"));
  } else if (rule.name == "pose") {
    if (has_reading) place.refuse("a pose after the first reading");
    scan.poses.push_back(parse_pose(rule, place));
    scan.readings.emplace_back();
  } else if (rule.name == "reading") {
    if (!has_checksum(line)) place.refuse("the checksum is wrong, the line is damaged");
    const std::size_t pose = numbers.next_whole(1e9, "the pose");
    if (pose >= scan.poses.size())
      place.refuse("pose " + std::to_string(pose) + " of " + std::to_string(scan.poses.size()));
    if (scan.readings[pose]) place.refuse("pose " + std::to_string(pose) + " is read a second time");
    scan.readings[pose] = parse_reading(numbers, scan.largest_count, place);
    has_reading = true;
  } else {
    place.refuse(quoted(rule.name) + " is unknown, expected largest_count, pose or reading");
  }
}

GONIO_INLINE std::string_view whole_lines(std::string_view text) {
  text = text.substr(0, text.find_last_of('\n') + 1);
  if (text.empty()) return text;
  const std::size_t begin = text.substr(0, text.size() - 1).find_last_of('\n') + 1;
  const std::string_view last = text.substr(begin, text.size() - 1 - begin);
  return last.starts_with("reading") && !has_checksum(last) ? text.substr(0, begin) : text;
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE recorded_scan parse_scan(std::string_view text, const std::string& name) {
  recorded_scan scan;
  detail::text_place place{name};
  bool has_reading = false;
  detail::for_each_line(detail::whole_lines(text), place,
                        [&](std::string_view line) { detail::apply_scan_line(line, place, scan, has_reading); });
  if (scan.largest_count == 0) throw error{name, ": the line largest_count is missing"};
  if (scan.poses.empty()) throw error{name, ": there is no pose"};
  return scan;
}

GONIO_INLINE recorded_scan read_scan(const std::filesystem::path& path) {
  const auto bytes = read_bytes(path);
  return parse_scan(detail::as_text(bytes), path.string());
}

GONIO_INLINE scan_journal::scan_journal(const std::filesystem::path& path, std::span<const direction_pair> poses,
                                        std::uint16_t largest_count)
    : path_(path) {
  if (poses.empty()) throw error{path.string(), ": a scan needs a pose, and there is none"};
  if (!std::filesystem::exists(path)) {
    const std::string header = detail::format_scan_header(poses, largest_count);
    write_atomically(path, std::as_bytes(std::span(header)));
  }
  open();
  const auto bytes = read_bytes(path);
  const std::string_view text = detail::as_text(bytes);
  scan_ = parse_scan(text, path.string());
  require_same(poses, largest_count);
  // The next line must not be joined to what a killed process left of its last.
  if (::ftruncate(file_.get(), static_cast<off_t>(detail::whole_lines(text).size())) != 0) fail();
}

GONIO_INLINE void scan_journal::add(std::size_t pose, const reading& taken) {
  if (has(pose)) throw error{path_.string(), ": pose ", pose, " is read already"};
  const std::string line = detail::format_reading(pose, taken);
  for (std::string_view left = line; !left.empty();) {
    const ssize_t count = ::write(file_.get(), left.data(), left.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail();
    left.remove_prefix(static_cast<std::size_t>(count));
  }
  if (::fsync(file_.get()) != 0 && errno != EINVAL) fail();
  scan_.readings[pose] = taken;
}

GONIO_INLINE void scan_journal::open() {
  // Without O_NONBLOCK, opening a pipe that nobody reads from would wait forever.
  file_ = detail::descriptor(::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | O_NONBLOCK));
  if (!file_.is_open()) fail();
  if (::flock(file_.get(), LOCK_EX | LOCK_NB) == 0) return;
  if (errno == EWOULDBLOCK) throw error{path_.string(), ": another process is scanning into this file"};
  fail();
}

GONIO_INLINE void scan_journal::require_same(std::span<const direction_pair> poses, std::uint16_t largest_count) const {
  if (scan_.largest_count != largest_count)
    throw error{path_.string(), ": is a scan by a camera of ", scan_.largest_count, " counts, not ", largest_count};
  const auto same = [](const direction_pair& a, const direction_pair& b) { return a.wi == b.wi && a.wo == b.wo; };
  if (!std::ranges::equal(scan_.poses, poses, same))
    throw error{path_.string(), ": is a scan of ", scan_.poses.size(), " other poses, expected the ",
                poses.size(),   " of this plan"};
}

}  // namespace gonio::io
