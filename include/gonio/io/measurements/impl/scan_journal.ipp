#pragma once
/// Bodies of io/measurements/scan_journal.hpp.

#include <gonio/capture/device.hpp>
#include <gonio/capture/scan.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/io/bytes/checked_file.hpp>
#include <gonio/io/measurements/scan_journal.hpp>
#include <gonio/io/text/rules.hpp>

#include <fcntl.h>
#include <sys/file.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace gonio::io::detail {

GONIO_INLINE std::string with_checksum(std::string fields) {
  return fields + " " + std::to_string(checksum(fields)) + "\n";
}

GONIO_INLINE bool has_checksum(std::string_view line) {
  const std::size_t last = line.find_last_of(' ');
  return last != std::string_view::npos && with_checksum(std::string(line.substr(0, last))) == std::string(line) + "\n";
}

GONIO_INLINE bool has_control_characters(std::string_view text) {
  return std::ranges::any_of(text, [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; });
}

/// Returns the line of a pose up to its last component.
GONIO_INLINE std::string pose_fields(std::string text, const direction_pair& pose) {
  for (const direction& w : {pose.wi, pose.wo})
    for (const double component : w) text += ' ' + shortest(component);
  return text;
}

GONIO_INLINE std::string write_pose(const direction_pair& pose) { return pose_fields("pose", pose) + '\n'; }

GONIO_INLINE std::string write_added_pose(const direction_pair& pose) {
  return with_checksum(pose_fields("added_pose", pose));
}

GONIO_INLINE std::string write_scan_header(const scan_subject& subject, std::span<const direction_pair> poses,
                                           std::uint16_t largest_count) {
  for (const std::string& text : {subject.sample, subject.setup})
    if (text.empty() || trimmed(text) != text || has_control_characters(text))
      gonio::refuse({"the sample and the set-up of a scan need one line of text each, not ", in_quotes(text)});
  std::string pose_lines;
  for (const direction_pair& pose : poses) pose_lines += write_pose(pose);
  return "# gonio scan: the sample, the set-up and the seed; the number of poses and their "
         "checksum;\n"
         "# wi and wo of each pose; number, frames, times, pixels, counts and checksum of each reading\n"
         "sample " +
         std::to_string(subject.checksum) + ' ' + subject.sample + '\n' + "setup " +
         std::to_string(checksum(subject.setup)) + ' ' + subject.setup + '\n' + "seed " + std::to_string(subject.seed) +
         '\n' + "largest_count " + std::to_string(largest_count) + '\n' + "plan " + std::to_string(poses.size()) + ' ' +
         std::to_string(checksum(pose_lines)) + '\n' + pose_lines;
}

GONIO_INLINE std::string write_reading(std::size_t pose, const capture::reading& taken) {
  std::string fields = "reading " + std::to_string(pose) + ' ' + std::to_string(taken.frames.size());
  for (const double time : taken.times) fields += ' ' + shortest(time);
  fields += ' ' + std::to_string(taken.frames.front().rows());
  for (const capture::camera_frame& each : taken.frames)
    for (const std::uint16_t count : each.reshaped()) fields += ' ' + std::to_string(count);
  return with_checksum(std::move(fields));
}

GONIO_INLINE double number_reader::next() {
  if (used_ == rule_.numbers.size()) position_.refuse("ends after " + std::to_string(used_) + " numbers");
  return rule_.numbers[used_++];
}

GONIO_INLINE std::size_t number_reader::next_whole(double most, const std::string& what) {
  const double value = next();
  if (!(value >= 0.0 && value <= most && value == std::floor(value)))
    position_.refuse(what + " is " + shortest(value) + ", expected a whole number up to " + shortest(most));
  return static_cast<std::size_t>(value);
}

GONIO_INLINE capture::reading read_reading(number_reader& numbers, std::uint16_t largest_count,
                                           const text_position& position) {
  capture::reading taken;
  const std::size_t frames = numbers.next_whole(1000, "the number of frames");
  for (std::size_t i = 0; i < frames; ++i) {
    taken.times.push_back(numbers.next());
    if (!(taken.times.back() > 0.0)) position.refuse("an exposure time must be positive");
  }
  const std::size_t pixels = numbers.next_whole(1e6, "the number of pixels");
  if (frames == 0 || pixels == 0) position.refuse("a reading needs at least one frame of at least one pixel");
  if (numbers.left() != frames * pixels * 3 + 1)  // the last number is the checksum
    position.refuse("has " + std::to_string(numbers.left() - std::min<std::size_t>(numbers.left(), 1)) +
                    " counts, expected " + std::to_string(frames * pixels * 3));
  for (std::size_t i = 0; i < frames; ++i) {
    capture::camera_frame each(pixels, 3);
    for (std::uint16_t& count : each.reshaped())
      count = static_cast<std::uint16_t>(numbers.next_whole(largest_count, "a count"));
    taken.frames.push_back(std::move(each));
  }
  return taken;
}

/// Are light and viewer unit vectors above the horizon?
GONIO_INLINE bool is_pose(const direction_pair& pose) {
  const auto is_above = [](const direction& w) { return std::abs(w.norm() - 1.0) < 1e-6 && w.z() > 0.0; };
  return is_above(pose.wi) && is_above(pose.wo);
}

GONIO_INLINE direction_pair read_pose(const text_rule& rule, std::size_t numbers, const text_position& position) {
  require_numbers(rule, {numbers}, position);
  const direction_pair pose{direction::Map(rule.numbers.data()), direction::Map(rule.numbers.data() + 3)};
  if (!is_pose(pose)) position.refuse("a pose needs two unit vectors above the horizon");
  return pose;
}

GONIO_INLINE bool apply_subject_line(std::string_view line, const text_position& position, scan_lines& before) {
  const std::size_t blank = std::min(line.find(' '), line.size());
  const std::string_view name = line.substr(0, blank);
  if (name != "sample" && name != "setup" && name != "seed") return false;
  const std::string_view rest = trimmed(line.substr(blank));
  std::uint64_t number = 0;
  const auto [end, failed] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
  const std::string_view text = trimmed(rest.substr(static_cast<std::size_t>(end - rest.data())));
  if (failed != std::errc()) position.refuse({in_quotes(name), " needs a whole number first"});
  if (text.empty() != (name == "seed"))
    position.refuse({in_quotes(name), name == "seed" ? " takes no text" : " needs a text"});
  if (has_control_characters(text)) position.refuse({in_quotes(name), " has control characters"});
  bool& has = name == "sample" ? before.has_sample : name == "setup" ? before.has_setup : before.has_seed;
  if (has) position.refuse({in_quotes(name), " appears twice"});
  has = true;
  if (name == "seed") {
    before.subject.seed = number;
  } else if (name == "sample") {
    before.subject.sample = text;
    before.subject.checksum = static_cast<std::uint32_t>(number);
  } else {
    if (number != checksum(text)) position.refuse("the checksum of 'setup' is wrong, the line is damaged");
    before.subject.setup = text;
  }
  return true;
}

GONIO_INLINE void apply_scan_line(std::string_view line, const text_position& position, recorded_scan& scan,
                                  scan_lines& before) {
  if (apply_subject_line(line, position, before)) return;
  const text_rule rule = read_rule(line, position);
  number_reader numbers(rule, position);
  if (rule.name == "largest_count") {
    require_numbers(rule, {1}, position);
    scan.largest_count = static_cast<std::uint16_t>(numbers.next_whole(65535, "the largest count"));
  } else if (rule.name == "plan") {
    require_numbers(rule, {2}, position);
    const std::size_t poses = numbers.next_whole(1e9, "the number of poses");
    before.plan.emplace(poses, static_cast<std::uint32_t>(numbers.next_whole(4294967295.0, "the poses' checksum")));
  } else if (rule.name == "pose") {
    if (before.has_reading) position.refuse("a pose follows the first reading");
    if (scan.poses.size() > scan.planned) position.refuse("a planned pose follows an added one");
    scan.poses.push_back(read_pose(rule, 6, position));
    scan.readings.emplace_back();
    ++scan.planned;
    before.pose_lines.append(line).push_back('\n');
  } else if (rule.name == "added_pose") {
    if (!has_checksum(line)) position.refuse("the checksum is wrong, the line is damaged");
    scan.poses.push_back(read_pose(rule, 7, position));
    scan.readings.emplace_back();
  } else if (rule.name == "reading") {
    if (!has_checksum(line)) position.refuse("the checksum is wrong, the line is damaged");
    const std::size_t pose = numbers.next_whole(1e9, "the pose");
    if (pose >= scan.poses.size())
      position.refuse("there is no pose " + std::to_string(pose) + ", expected less than " +
                      std::to_string(scan.poses.size()));
    if (scan.readings[pose]) position.refuse("pose " + std::to_string(pose) + " has a second reading");
    scan.readings[pose] = read_reading(numbers, scan.largest_count, position);
    before.has_reading = true;
  } else {
    position.refuse(in_quotes(rule.name) +
                    " is unknown, expected sample, setup, seed, largest_count, plan, pose, added_pose or reading");
  }
}

GONIO_INLINE void finish_scan(recorded_scan& scan, const scan_lines& all, const std::string& name) {
  // Readings come last: if there is none, the process may have been killed while it wrote the header.
  const std::string_view again =
      all.has_reading ? "" : "; if the scan was stopped before its first reading, the same command restarts it";
  if (scan.largest_count == 0) gonio::refuse({name, ": the line largest_count is missing", again});
  if (scan.planned == 0) gonio::refuse({name, ": there is no pose", again});
  if (all.plan && (all.plan->first != scan.planned || all.plan->second != checksum(all.pose_lines)))
    gonio::refuse(
        {name, ": the poses differ from the ", all.plan->first, " of the line 'plan', the file is damaged", again});
  if (all.has_sample != all.has_setup || all.has_sample != all.has_seed || all.has_sample != all.plan.has_value())
    gonio::refuse({name, ": some of the lines sample, setup, seed and plan are missing"});
  if (all.has_sample) scan.subject = all.subject;
}

GONIO_INLINE std::string_view whole_lines(std::string_view text) {
  text = text.substr(0, text.find_last_of('\n') + 1);
  if (text.empty()) return text;
  const std::size_t begin = text.substr(0, text.size() - 1).find_last_of('\n') + 1;
  const std::string_view last = text.substr(begin, text.size() - 1 - begin);
  const bool has_its_own = last.starts_with("reading") || last.starts_with("added_pose");
  return has_its_own && !has_checksum(last) ? text.substr(0, begin) : text;
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE std::uint32_t checksum_of_file(const std::filesystem::path& path) {
  const auto bytes = read_bytes(path);
  return checksum(bytes);
}

GONIO_INLINE recorded_scan read_scan(std::string_view text, const std::string& name) {
  recorded_scan scan;
  text_position position{name};
  detail::scan_lines before;
  for_each_line(detail::whole_lines(text), position,
                [&](std::string_view line) { detail::apply_scan_line(line, position, scan, before); });
  detail::finish_scan(scan, before, name);
  return scan;
}

GONIO_INLINE recorded_scan read_scan(const std::filesystem::path& path) {
  const auto bytes = read_bytes(path);
  return read_scan(as_text(bytes), path.string());
}

GONIO_INLINE scan_journal::scan_journal(const std::filesystem::path& path, const scan_subject& subject,
                                        std::span<const direction_pair> poses, std::uint16_t largest_count)
    : path_(path) {
  if (poses.empty()) gonio::refuse({path.string(), ": a scan needs at least one pose"});
  const std::string header = detail::write_scan_header(subject, poses, largest_count);
  open();
  auto bytes = read_bytes(path);
  if (bytes.size() < header.size() && header.starts_with(as_text(bytes))) {
    // The file is new, or a process was killed while it wrote this header.
    write(std::string_view(header).substr(bytes.size()));
    bytes = read_bytes(path);
  }
  const std::string_view text = as_text(bytes);
  scan_ = read_scan(text, path.string());
  require_same(subject, poses, largest_count);
  // Remove an incomplete last line, so that the next line is not joined to it.
  if (::ftruncate(file_.get(), static_cast<off_t>(detail::whole_lines(text).size())) != 0) fail();
}

GONIO_INLINE void scan_journal::add(std::size_t pose, const capture::reading& taken) {
  if (has(pose)) gonio::refuse({path_.string(), ": pose ", pose, " already has a reading"});
  write(detail::write_reading(pose, taken));
  scan_.readings[pose] = taken;
}

GONIO_INLINE void scan_journal::add_pose(const direction_pair& pose) {
  if (!detail::is_pose(pose)) gonio::refuse({path_.string(), ": a pose needs two unit vectors above the horizon"});
  write(detail::write_added_pose(pose));
  scan_.poses.push_back(pose);
  scan_.readings.emplace_back();
}

GONIO_INLINE void scan_journal::open() {
  // Without O_NONBLOCK, opening a pipe without a reader would wait forever.
  file_ = descriptor(::open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NONBLOCK, 0666));
  if (!file_.is_open()) fail();
  if (::flock(file_.get(), LOCK_EX | LOCK_NB) == 0) return;
  if (errno == EWOULDBLOCK) gonio::refuse({path_.string(), ": another process is scanning into this file"});
  fail();
}

GONIO_INLINE void scan_journal::write(std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = ::write(file_.get(), text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail();
    text.remove_prefix(static_cast<std::size_t>(count));
  }
  if (::fsync(file_.get()) != 0 && errno != EINVAL) fail();
}

GONIO_INLINE void scan_journal::require_same(const scan_subject& subject, std::span<const direction_pair> poses,
                                             std::uint16_t largest_count) const {
  const std::string name = path_.string();
  if (scan_.largest_count != largest_count)
    gonio::refuse({name, ": the scan's camera counts up to ", scan_.largest_count, ", not up to ", largest_count});
  const auto same = [](const direction_pair& a, const direction_pair& b) { return a.wi == b.wi && a.wo == b.wo; };
  if (!std::ranges::equal(std::span(scan_.poses).first(scan_.planned), poses, same))
    gonio::refuse(
        {name, ": is a scan of ", scan_.planned, " other poses, expected the ", poses.size(), " of this plan"});
  if (!scan_.subject)
    gonio::refuse({name,
                   ": does not name its sample, because an earlier version wrote the file: the scan can be calibrated, "
                   "but not continued"});
  const scan_subject& known = *scan_.subject;
  if (known.sample != subject.sample)
    gonio::refuse({name, ": is a scan of '", known.sample, "', not of '", subject.sample, "'"});
  if (known.checksum != subject.checksum)
    gonio::refuse({name, ": is a scan of another '", known.sample, "', of checksum ", known.checksum, ", not ",
                   subject.checksum});
  if (known.setup != subject.setup)
    gonio::refuse({name, ": was measured with '", known.setup, "', not with '", subject.setup, "'"});
  if (known.seed != subject.seed)
    gonio::refuse({name, ": was measured with the seed ", known.seed, ", not ", subject.seed});
}

}  // namespace gonio::io
