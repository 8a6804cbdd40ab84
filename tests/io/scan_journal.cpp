#include "scratch.hpp"
#include <gonio/io/measurements/scan_journal.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <random>

using doctest::Contains;
using gonio::direction_pair;
using gonio::capture::reading;
using gonio::io::scan_journal;
namespace io = gonio::io;

namespace {

const io::scan_subject oak{.sample = "oak board", .checksum = 7, .setup = "gantry, linear", .seed = 3};

std::vector<direction_pair> poses(std::size_t count) {
  std::vector<direction_pair> all;
  for (std::size_t i = 0; i < count; ++i)
    all.push_back(
        {gonio::spherical_direction(0.3, 0.0), gonio::spherical_direction(0.1 + 0.1 * static_cast<double>(i), 2.0)});
  return all;
}

reading random_reading(std::size_t frames, Eigen::Index pixels, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::uniform_int_distribution<int> count(0, 4095);
  reading taken;
  for (std::size_t i = 0; i < frames; ++i) {
    taken.times.push_back(0.0125 * std::pow(2.0, static_cast<double>(i)) / 3.0);
    taken.frames.push_back(gonio::capture::camera_frame::NullaryExpr(
        pixels, 3, [&](Eigen::Index, Eigen::Index) { return static_cast<std::uint16_t>(count(generator)); }));
  }
  return taken;
}

bool same(const reading& a, const reading& b) {
  return a.times == b.times &&
         std::ranges::equal(a.frames, b.frames, [](const auto& x, const auto& y) { return (x == y).all(); });
}

std::string text_of(const std::filesystem::path& path) {
  const auto bytes = io::read_bytes(path);
  return std::string(io::as_text(bytes));
}

void write(const std::filesystem::path& path, const std::string& text) {
  io::write_atomically(path, std::as_bytes(std::span(text)));
}

}  // namespace

TEST_CASE("scan journal: added readings are read back and kept when the scan resumes") {
  const scratch::folder scratch;
  const auto path = scratch.path() / "a.scan";
  CHECK(rc::check("readings of any size come back", [&] {
    std::filesystem::remove(path);
    const auto count = *rc::gen::inRange<std::size_t>(1, 6);
    const auto frames = *rc::gen::inRange<std::size_t>(1, 5);
    const auto pixels = *rc::gen::inRange<Eigen::Index>(1, 5);
    const auto seed = *rc::gen::arbitrary<unsigned>();
    for (std::size_t i = count; i-- > 0;) {  // each by another journal, in reverse order of the poses
      scan_journal journal(path, oak, poses(count), 4095);
      RC_ASSERT(journal.scan().measured() == count - 1 - i);
      RC_ASSERT(!journal.has(i));
      journal.add(i, random_reading(frames, pixels, seed + static_cast<unsigned>(i)));
      RC_ASSERT(journal.has(i));
    }
    const io::recorded_scan read = io::read_scan(path);
    RC_ASSERT(read.largest_count == 4095);
    RC_ASSERT(read.subject.has_value());
    RC_ASSERT(read.subject->sample == oak.sample && read.subject->checksum == oak.checksum);
    RC_ASSERT(read.subject->setup == oak.setup && read.subject->seed == oak.seed);
    RC_ASSERT(read.poses.size() == count);
    for (std::size_t i = 0; i < count; ++i) {
      RC_ASSERT(read.poses[i].wi == poses(count)[i].wi);
      RC_ASSERT(read.poses[i].wo == poses(count)[i].wo);
      RC_ASSERT(read.readings[i].has_value());
      RC_ASSERT(same(*read.readings[i], random_reading(frames, pixels, seed + static_cast<unsigned>(i))));
    }
  }));
}

TEST_CASE("scan journal: if the last line is truncated, earlier lines are kept and the scan resumes") {
  const scratch::folder scratch;
  const auto path = scratch.path() / "a.scan";
  {
    scan_journal journal(path, oak, poses(3), 4095);
    journal.add(0, random_reading(2, 2, 1));
  }
  const std::string before = text_of(path);
  {
    scan_journal journal(path, oak, poses(3), 4095);
    journal.add(1, random_reading(2, 2, 2));
  }
  const std::string whole = text_of(path);
  REQUIRE(whole.size() > before.size());
  for (std::size_t size = before.size(); size < whole.size(); ++size) {
    write(path, whole.substr(0, size));
    CHECK(io::read_scan(path).measured() == 1u);
    scan_journal journal(path, oak, poses(3), 4095);
    CHECK(text_of(path) == before);
    journal.add(1, random_reading(2, 2, 2));
    CHECK(text_of(path) == whole);
  }
  // After a power failure the file may have a line's end without all bytes before it.
  std::string holed = whole;
  holed.replace(holed.size() - 12, 4, 4, '\0');
  write(path, holed);
  CHECK(io::read_scan(path).measured() == 1u);
}

TEST_CASE("scan journal: damaged files and other scans are refused and left unchanged") {
  const scratch::folder scratch;
  const auto path = scratch.path() / "a.scan";
  {
    scan_journal journal(path, oak, poses(3), 4095);
    journal.add(0, random_reading(1, 1, 1));
    journal.add(1, random_reading(1, 1, 2));
    CHECK_THROWS_WITH_AS(journal.add(1, random_reading(1, 1, 3)), Contains("pose 1 already has a reading"),
                         gonio::error);
    CHECK_THROWS_WITH_AS(scan_journal(path, oak, poses(3), 4095), Contains("another process"), gonio::error);
  }
  const std::string whole = text_of(path);
  const auto refuses = [&](const std::string& text, const char* message) {
    write(path, text);
    CHECK_THROWS_WITH_AS((void)io::read_scan(path), Contains(message), gonio::error);
    CHECK_THROWS_WITH_AS(scan_journal(path, oak, poses(3), 4095), Contains(message), gonio::error);
    CHECK(text_of(path) == text);
  };
  const std::size_t first = whole.find("reading 0");
  std::string damaged = whole;
  damaged[first + 12] = damaged[first + 12] == '1' ? '2' : '1';
  refuses(damaged, "line 11: the checksum is wrong");
  const std::string second = whole.substr(whole.find("reading 1"));
  refuses(whole + second, "pose 1 has a second reading");
  refuses(whole + "pose 1 0 0 0 0 1\n", "a pose follows the first reading");
  refuses(whole + "temperature 3\n", "'temperature' is unknown");
  CHECK_THROWS_WITH_AS((void)io::read_scan("", "a"), Contains("largest_count is missing"), gonio::error);
  refuses("largest_count 70000\n", "is 70000");
  refuses("largest_count 255\n", "there is no pose");
  refuses("largest_count 255\npose 0 0 2 0 0 1\n", "two unit vectors");
  refuses("largest_count 255\npose 0 0 1 0 0 1\n" + io::detail::with_checksum("reading 1 1 0.1 1 3 3 3") + "# end\n",
          "there is no pose 1, expected less than 1");
  refuses("largest_count 255\npose 0 0 1 0 0 1\n" + io::detail::with_checksum("reading 0 1 0.1 1 3 3") + "# end\n",
          "has 2 counts, expected 3");
  refuses("largest_count 255\npose 0 0 1 0 0 1\n" + io::detail::with_checksum("reading 0 1 0.1 1 3 3 256") + "# end\n",
          "a count is 256");
  refuses("largest_count 255\npose 0 0 1 0 0 1\n" + io::detail::with_checksum("reading 0 900 0.1") + "# end\n",
          "ends after");

  write(path, whole);
  CHECK_THROWS_WITH_AS(scan_journal(path, oak, poses(2), 4095), Contains("3 other poses, expected the 2"),
                       gonio::error);
  CHECK_THROWS_WITH_AS(scan_journal(path, oak, poses(3), 255), Contains("counts up to 4095, not up to 255"),
                       gonio::error);
  CHECK_THROWS_WITH_AS(scan_journal(path, oak, {}, 4095), Contains("needs at least one pose"), gonio::error);
  CHECK_THROWS_WITH_AS(scan_journal(scratch.path() / "no folder" / "a.scan", oak, poses(1), 4095),
                       Contains("cannot be written"), gonio::error);
  CHECK_THROWS_WITH_AS(scan_journal(scratch.path(), oak, poses(1), 4095), Contains("cannot be written"), gonio::error);
  CHECK(text_of(path) == whole);
}

TEST_CASE("scan journal: a scan of another subject is refused and left unchanged") {
  const scratch::folder scratch;
  const auto path = scratch.path() / "a.scan";
  { scan_journal(path, oak, poses(2), 4095).add(0, random_reading(1, 1, 1)); }
  const std::string whole = text_of(path);
  const auto refuses = [&](const io::scan_subject& other, const char* message) {
    CHECK_THROWS_WITH_AS(scan_journal(path, other, poses(2), 4095), Contains(message), gonio::error);
    CHECK(text_of(path) == whole);
  };
  io::scan_subject other = oak;
  other.sample = "white";
  refuses(other, "a.scan: is a scan of 'oak board', not of 'white'");
  other = oak;
  other.checksum = 8;
  refuses(other, "is a scan of another 'oak board', of checksum 7, not 8");
  other = oak;
  other.setup = "robot";
  refuses(other, "was measured with 'gantry, linear', not with 'robot'");
  other = oak;
  other.seed = 4;
  refuses(other, "was measured with the seed 3, not 4");
  other = oak;
  other.sample = "two\nlines";
  refuses(other, "one line of text");
  other.sample = "";
  refuses(other, "one line of text");
}

TEST_CASE("scan journal: a damaged or incomplete header is refused") {
  const scratch::folder scratch;
  const auto path = scratch.path() / "a.scan";
  { scan_journal(path, oak, poses(2), 4095).add(0, random_reading(1, 1, 1)); }
  const std::string whole = text_of(path);
  const auto refuses = [&](const std::string& from, const std::string& to, const char* message) {
    std::string text = whole;
    REQUIRE(text.find(from) != std::string::npos);
    write(path, text.replace(text.find(from), from.size(), to));
    CHECK_THROWS_WITH_AS((void)io::read_scan(path), Contains(message), gonio::error);
  };
  refuses("gantry", "gabtry", "line 4: the checksum of 'setup' is wrong");
  refuses("plan 2", "plan 3", "the poses differ from the 3");
  refuses(" 0 0.955", " -0 0.955", "the poses differ from the 2");
  refuses("seed 3\n", "", "some of the lines");
  refuses("seed 3", "seed three", "'seed' needs a whole number first");
  refuses("seed 3", "seed 3 4", "'seed' takes no text");
  refuses("sample 7 oak board", "sample 7", "'sample' needs a text");
  refuses("sample 7 oak board", "sample 7 \x1b[2J", "control characters");
  refuses("seed 3", "seed 3\nseed 3", "'seed' appears twice");
}

TEST_CASE("scan journal: a truncated header is refused by the reader and restarted by the same scan") {
  const scratch::folder scratch;
  const auto path = scratch.path() / "a.scan";
  { scan_journal(path, oak, poses(2), 4095); }
  const std::string head = text_of(path);
  for (std::size_t size = 0; size < head.size(); ++size) {
    write(path, head.substr(0, size));
    CHECK_THROWS_WITH_AS((void)io::read_scan(path), Contains("the same command restarts it"), gonio::error);
    { scan_journal(path, oak, poses(2), 4095); }
    CHECK(text_of(path) == head);
  }
}

TEST_CASE("scan journal: poses added during the scan are read back completely or not at all") {
  const scratch::folder scratch;
  const auto path = scratch.path() / "a.scan";
  const direction_pair added{gonio::spherical_direction(0.7, 0.2), gonio::spherical_direction(0.4, 1.0)};
  {
    scan_journal journal(path, oak, poses(2), 4095);
    journal.add(0, random_reading(1, 1, 1));
  }
  const std::string before = text_of(path);
  {
    scan_journal journal(path, oak, poses(2), 4095);
    journal.add_pose(added);
    CHECK_FALSE(journal.has(2));
  }
  const std::string with_pose = text_of(path);
  // A truncated pose is added again.
  for (std::size_t size = before.size(); size < with_pose.size(); ++size) {
    write(path, with_pose.substr(0, size));
    scan_journal journal(path, oak, poses(2), 4095);
    CHECK(journal.scan().poses.size() == 2u);
    journal.add_pose(added);
    CHECK(text_of(path) == with_pose);
  }
  scan_journal(path, oak, poses(2), 4095).add(2, random_reading(2, 1, 2));
  const io::recorded_scan read = io::read_scan(path);
  CHECK(read.planned == 2u);
  REQUIRE(read.poses.size() == 3u);
  CHECK(read.poses[2].wi == added.wi);
  CHECK(read.poses[2].wo == added.wo);
  CHECK(same(*read.readings[2], random_reading(2, 1, 2)));
  // Added poses are not part of the plan.
  CHECK_THROWS_WITH_AS(scan_journal(path, oak, read.poses, 4095), Contains("a scan of 2 other poses, expected the 3"),
                       gonio::error);

  scan_journal journal(path, oak, poses(2), 4095);
  CHECK_THROWS_WITH_AS(journal.add_pose({added.wi, -added.wo}), Contains("above the horizon"), gonio::error);
  std::string late = text_of(path);
  late += "pose 0 0 1 0 0 1\n";
  write(path, late);
  CHECK_THROWS_WITH_AS(io::read_scan(path), Contains("a pose follows the first reading"), gonio::error);
  std::string damaged = with_pose + with_pose.substr(before.size());
  damaged[before.size() + 12] = damaged[before.size() + 12] == '1' ? '2' : '1';
  write(path, damaged);
  CHECK_THROWS_WITH_AS(io::read_scan(path), Contains("the checksum is wrong"), gonio::error);
}

TEST_CASE("scan journal: a scan of an earlier version is read, but not resumed") {
  const scratch::folder scratch;
  const auto path = scratch.path() / "a.scan";
  { scan_journal(path, oak, poses(2), 4095).add(0, random_reading(1, 1, 1)); }
  std::string text = text_of(path);
  const std::size_t begin = text.find("sample "), end = text.find("largest_count"), plan = text.find("plan ");
  text.erase(plan, text.find('\n', plan) + 1 - plan).erase(begin, end - begin);
  write(path, text);
  CHECK(io::read_scan(path).measured() == 1u);
  CHECK_FALSE(io::read_scan(path).subject.has_value());
  CHECK_THROWS_WITH_AS(scan_journal(path, oak, poses(2), 4095), Contains("does not name its sample"), gonio::error);
  CHECK(text_of(path) == text);
}

TEST_CASE("scan journal: a truncated header is completed; other content stays") {
  const scratch::folder scratch;
  const auto path = scratch.path() / "a.scan";
  { const scan_journal journal(path, oak, poses(2), 4095); }
  const std::string head = text_of(path);
  for (std::size_t size = 0; size < head.size(); ++size) {
    write(path, head.substr(0, size));
    const scan_journal journal(path, oak, poses(2), 4095);
    CHECK(text_of(path) == head);
  }
  write(path, head.substr(0, 50) + "?");
  CHECK_THROWS_AS(scan_journal(path, oak, poses(2), 4095), gonio::error);
  CHECK(text_of(path) == head.substr(0, 50) + "?");
}
