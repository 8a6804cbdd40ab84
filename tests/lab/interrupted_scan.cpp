#include "../io/scratch.hpp"
#include "synthetic_scan.hpp"
#include <gonio/io/measurements/scan_journal.hpp>

#include <doctest/doctest.h>
#include <lab/gantry.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <string>

namespace {

/// A gantry that takes a millisecond for each pose, as a real one takes seconds, and writes down each measurement.
class slow_gantry : public lab::gantry {
 public:
  slow_gantry(lab::dark_room& room, const std::filesystem::path& log)
      : lab::gantry(room), log_(::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666)) {}

  [[nodiscard]] gonio::capture::reading measure(const gonio::direction_pair& pair) {
    const std::string line = std::to_string(pair.wo.x()) + '\n';
    if (::write(log_.get(), line.data(), line.size()) < 0) throw gonio::capture::device_failure("no log");
    ::usleep(1000);
    return lab::gantry::measure(pair);
  }

 private:
  gonio::io::descriptor log_;
};

void scan_into(const std::filesystem::path& journal_path, const std::filesystem::path& log,
               const std::vector<gonio::direction_pair>& poses) {
  lab::sensor chip = lab::sensor::usual();
  chip.side = 2;
  lab::dark_room room(glossy, chip, {.flicker = 0.01}, 1, 2);
  slow_gantry machine(room, log);
  gonio::io::scan_journal journal(journal_path, {.sample = "glossy", .setup = "gantry"}, poses,
                                  machine.largest_count());
  gonio::capture::scan(machine, poses, journal);
}

/// Scans in a process of its own, which is killed after some microseconds unless it has ended by then.
void scan_and_kill(const std::filesystem::path& journal, const std::filesystem::path& log,
                   const std::vector<gonio::direction_pair>& poses, unsigned microseconds) {
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    try {
      scan_into(journal, log, poses);
      ::_exit(0);
    } catch (...) {
      ::_exit(1);
    }
  }
  ::usleep(microseconds);
  ::kill(child, SIGKILL);
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  CHECK((WIFSIGNALED(status) || WEXITSTATUS(status) == 0));
}

std::string text_of(const std::filesystem::path& path) {
  const auto bytes = gonio::io::read_bytes(path);
  return std::string(gonio::io::as_text(bytes));
}

/// Does a scan's file hold all of its plan? A process may be killed before it has written it down.
bool has_begun(const std::filesystem::path& journal, std::size_t poses) {
  if (!std::filesystem::exists(journal)) return false;
  const std::string text = text_of(journal);
  std::size_t whole = 0;
  for (std::size_t at = text.find("\npose "); at != std::string::npos; at = text.find("\npose ", at + 1))
    whole += text.find('\n', at + 1) != std::string::npos ? 1 : 0;
  return whole == poses;
}

/// The lines of a text in alphabetical order.
std::vector<std::string> sorted_lines(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  std::ranges::sort(lines);
  return lines;
}

}  // namespace

TEST_CASE("lab: a scan that is killed 50 times reads each pose once, and the same counts as one that is not") {
  const scratch::folder folder;
  std::vector<gonio::direction_pair> poses;
  lab::dark_room room(glossy, {}, {});
  for (const auto& pair : scattered_pairs(600, 3))
    if (lab::gantry(room).place(pair).is_reachable()) poses.push_back(pair);
  REQUIRE(poses.size() > 400);

  const auto journal = folder.path() / "killed.scan", log = folder.path() / "killed.log";
  std::mt19937_64 generator(11);
  std::uniform_int_distribution<unsigned> microseconds(500, 30'000);
  int killed_while_scanning = 0;
  std::size_t kept = 0;
  for (int i = 0; i < 50; ++i) {
    scan_and_kill(journal, log, poses, microseconds(generator));
    if (!has_begun(journal, poses.size())) {
      CHECK(kept == 0);
      continue;
    }
    const std::size_t now = gonio::io::read_scan(journal).measured();
    CHECK(now >= kept);  // nothing is lost
    kept = now;
    killed_while_scanning += kept < poses.size() ? 1 : 0;
  }
  CHECK(killed_while_scanning > 20);
  scan_into(journal, log, poses);
  scan_into(folder.path() / "whole.scan", folder.path() / "whole.log", poses);

  CHECK(gonio::io::read_scan(journal).measured() == poses.size());
  CHECK(text_of(journal) == text_of(folder.path() / "whole.scan"));
  // Measured a second time is at most what each kill interrupted.
  const auto measurements = sorted_lines(text_of(log));
  CHECK(measurements.size() >= poses.size());
  CHECK(measurements.size() <= poses.size() + 50);
  MESSAGE(poses.size() << " poses, killed " << killed_while_scanning << " times before the end, "
                       << measurements.size() - poses.size() << " poses were interrupted and measured again");
}

TEST_CASE("lab: a camera that fails in the middle of a scan leaves the lamp off, and the rest for the next scan") {
  /// Fails at every tenth exposure from some on.
  struct failing_gantry : lab::gantry {
    lab::dark_room* room;
    int* measured;
    failing_gantry(lab::dark_room& where, int& count) : lab::gantry(where), room(&where), measured(&count) {}
    gonio::capture::reading measure(const gonio::direction_pair& pair) {
      const gonio::capture::reading taken = lab::gantry::measure(pair);
      if (++*measured % 5 < 2) throw gonio::capture::device_failure("a frame is missing");
      return taken;
    }
  };
  lab::dark_room room(glossy, {}, {});
  int measured = 0;
  failing_gantry machine(room, measured);
  const auto poses = gonio::capture::plan_scan(machine, scattered_pairs(40, 4)).poses;
  lab::scan_in_memory record;
  std::size_t scans = 0;
  while (record.readings.size() < poses.size() && ++scans < 20) {
    const std::size_t before = record.readings.size();
    const auto outcome = gonio::capture::scan(machine, poses, record);
    CHECK(outcome.kept_before == before);
    CHECK(record.readings.size() == before + outcome.measured);
    CHECK(room.expose(0.1).maxCoeff() == 0);
  }
  CHECK(record.readings.size() == poses.size());
  CHECK(scans > 1u);
}
