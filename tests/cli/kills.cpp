/// Long-running commands, killed at random moments: the output is the old one or a complete new one, and no other file
/// is left. GONIO_KILLS sets how often each command is killed (docs/decisions/0017-unfinished-files.md).

#include "../io/scratch.hpp"
#include "tool.hpp"
#include <gonio/io/bytes/file.hpp>

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace {

using seconds = std::chrono::duration<double>;

const std::string directions = std::string(GONIO_SOURCE_DIR) + "/examples/data/nielsen-20.csv";

int wanted_kills() {
  const char* given = std::getenv("GONIO_KILLS");
  return given == nullptr ? 2 : std::stoi(given);
}

/// A running tool and its folder.
class tool_at_work {
 public:
  tool_at_work(const std::string& arguments, const scratch::fs::path& folder) {
    const std::string line = "exec '" + std::string(GONIO_TOOL) + "' " + arguments;
    child_ = ::fork();
    REQUIRE(child_ >= 0);
    if (child_ != 0) return;
    for (const int signal : {SIGINT, SIGTERM}) ::signal(signal, SIG_DFL);  // background jobs of a shell ignore SIGINT
    const int nowhere = ::open("/dev/null", O_WRONLY);
    if (::chdir(folder.c_str()) != 0 || ::dup2(nowhere, 1) < 0 || ::dup2(nowhere, 2) < 0) ::_exit(126);
    ::execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
    ::_exit(127);
  }
  tool_at_work(const tool_at_work&) = delete;
  tool_at_work& operator=(const tool_at_work&) = delete;

  /// Sends a signal. Returns false if the tool had already ended.
  bool end(int signal) {
    ::kill(child_, signal);
    const int status = wait();
    if (WIFSIGNALED(status)) {
      CHECK(WTERMSIG(status) == signal);
      return true;
    }
    CHECK(WEXITSTATUS(status) == 0);
    return false;
  }

  /// Waits until the tool has opened a file to write into this folder, or has ended.
  void wait_until_it_writes(const scratch::fs::path& folder) const {
    const std::string unnamed = (folder / "#").native(), named = (folder / ".gonio-").native();
    const std::string journal = (folder / "paint.scan").native();
    const scratch::fs::path open = "/proc/" + std::to_string(child_) + "/fd";
    siginfo_t ended{};
    while (::waitid(P_PID, static_cast<id_t>(child_), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 && ended.si_pid == 0) {
      std::error_code gone;
      for (scratch::fs::directory_iterator file(open, gone), end; !gone && file != end; file.increment(gone)) {
        const std::string to = scratch::fs::read_symlink(file->path(), gone).native();
        if (to.starts_with(unnamed) || to.starts_with(named) || to == journal) return;
        gone.clear();  // it was closed in the meantime
      }
    }
  }

  int wait() {
    int status = 0;
    REQUIRE(::waitpid(child_, &status, 0) == child_);
    return status;
  }

 private:
  pid_t child_ = -1;
};

/// Runs the tool undisturbed and returns the duration.
seconds run(const std::string& arguments, const scratch::fs::path& folder) {
  const auto start = std::chrono::steady_clock::now();
  const int status = tool_at_work(arguments, folder).wait();
  REQUIRE_MESSAGE((WIFEXITED(status) && WEXITSTATUS(status) == 0), arguments);
  return std::chrono::steady_clock::now() - start;
}

std::vector<std::string> names_in(const scratch::fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : scratch::fs::directory_iterator(folder)) names.push_back(entry.path().filename());
  std::ranges::sort(names);
  return names;
}

/// Ends commands at random moments: half of them at any time of their run, half within 20 ms of their first write.
/// Seven of ten signals are SIGKILL, which cannot be handled.
class killer {
 public:
  explicit killer(unsigned seed) : random_(seed) {}

  bool kill_one(const std::string& arguments, const scratch::fs::path& folder, seconds duration) {
    constexpr std::array signals{SIGKILL, SIGKILL, SIGKILL, SIGKILL, SIGKILL,
                                 SIGKILL, SIGKILL, SIGINT,  SIGINT,  SIGTERM};
    std::uniform_real_distribution<double> share(0.0, 1.0);
    tool_at_work work(arguments, folder);
    if (kills_++ % 2 == 1) {
      std::this_thread::sleep_for(1.1 * share(random_) * duration);
    } else {
      work.wait_until_it_writes(folder);
      std::this_thread::sleep_for(share(random_) * seconds(0.02));
    }
    return work.end(signals[random_() % signals.size()]);
  }

 private:
  std::mt19937 random_;
  int kills_ = 0;
};

struct kill_counts {
  int killed = 0, old = 0, whole = 0, left_at_once = 0;
};

/// Kills a command that writes files, alternately over old files and into an empty folder. The next run continues from
/// `kept`.
void kill_writer(const std::string& what, const std::string& arguments, const std::vector<std::string>& outputs,
                 const scratch::folder& folder, unsigned seed, const std::string& kept = "") {
  const seconds duration = run(arguments, folder.path());
  std::map<std::string, std::string> whole;
  for (const std::string& output : outputs) whole[output] = scratch::get(folder / output);
  const std::vector<std::string> all = names_in(folder.path());

  killer ends(seed);
  kill_counts counts;
  for (int i = 0; i < wanted_kills(); ++i) {
    const bool has_old = i % 4 < 2;
    for (const std::string& output : outputs)
      if (has_old)
        scratch::put(folder / output, "old");
      else
        scratch::fs::remove(folder / output);
    counts.killed += ends.kill_one(arguments, folder.path(), duration) ? 1 : 0;
    for (const std::string& output : outputs) {
      const bool is_there = scratch::fs::exists(folder / output);
      const std::string now = is_there ? scratch::get(folder / output) : "";
      const bool is_old = has_old ? now == "old" : !is_there, is_whole = is_there && now == whole[output];
      CHECK((is_old || is_whole));
      counts.old += is_old ? 1 : 0;
      counts.whole += is_whole ? 1 : 0;
    }
    // If the kill falls between link and rename, the next write removes the leftover file.
    const auto left = [&] {
      const std::vector<std::string> names = names_in(folder.path());
      return std::ranges::any_of(
          names, [&](const auto& name) { return name != kept && !std::ranges::binary_search(all, name); });
    };
    if (left()) ++counts.left_at_once;
    gonio::io::write_atomically(folder / outputs.front(), std::span<const std::byte>());
    CHECK_FALSE(left());
  }
  run(arguments, folder.path());
  for (const std::string& output : outputs) CHECK(scratch::get(folder / output) == whole[output]);
  CHECK(names_in(folder.path()) == all);
  MESSAGE(what << ", " << duration.count() << " s: " << counts.killed << " of " << wanted_kills()
               << " killed before their end; of " << outputs.size() << " outputs each " << counts.old << " were old, "
               << counts.whole << " whole; " << counts.left_at_once << " left a file for the next run to remove");
}

}  // namespace

TEST_CASE("killed: gonio reconstruct leaves its output old or whole, and nothing else") {
  const scratch::folder folder;
  run("expand --formula red-paint -o truth.binary", folder.path());
  run("sample truth.binary --directions '" + directions + "' -o samples.csv", folder.path());
  kill_writer("reconstruct", "reconstruct samples.csv -o estimate.binary --image sphere.png",
              {"estimate.binary", "sphere.png"}, folder, 1);
}

TEST_CASE("killed: gonio learn leaves its output old or whole, and nothing else") {
  const scratch::folder folder;
  scratch::fs::create_directory(folder / "tables");
  for (const char* name : {"red-paint", "blue-rubber", "gold-metal"})
    run(std::string("expand --formula ") + name + " -o tables/" + name + ".binary", folder.path());
  kill_writer("learn", "learn --merl tables --components 2 -o my.prior", {"my.prior"}, folder, 2);
}

TEST_CASE("killed: gonio design leaves its output old or whole, goes on to the same bytes, and leaves nothing") {
  const scratch::folder folder;
  kill_writer("design", "design -n 8 --search greedy --criterion expected-error -o eight.csv", {"eight.csv"}, folder, 3,
              "eight.csv.part");
}

TEST_CASE("killed: gonio lab scan keeps whole lines, and goes on to the same bytes") {
  const scratch::folder folder;
  run("expand --formula red-paint -o truth.binary", folder.path());
  run("lab plan '" + directions + "' -o plan.csv", folder.path());
  const std::string scan = "lab scan plan.csv --material truth.binary -o paint.scan";
  const seconds duration = run(scan, folder.path());
  const std::string whole = scratch::get(folder / "paint.scan");
  scratch::fs::remove(folder / "paint.scan");

  killer ends(4);
  int killed = 0, grown = 0, begun_anew = 0;
  for (int i = 0; i < wanted_kills(); ++i) {
    const std::string before = scratch::get(folder / "paint.scan");
    if (before == whole) {
      scratch::fs::remove(folder / "paint.scan");
      ++begun_anew;
    }
    killed += ends.kill_one(scan, folder.path(), 0.5 * duration) ? 1 : 0;
    const std::string now = scratch::get(folder / "paint.scan");
    CHECK(whole.starts_with(now));
    CHECK((before == whole || now.size() >= before.substr(0, before.rfind('\n') + 1).size()));
    grown += !now.empty() && now != whole ? 1 : 0;
    CHECK(folder.entries() == (scratch::fs::exists(folder / "paint.scan") ? 3 : 2));
  }
  run(scan, folder.path());
  CHECK(scratch::get(folder / "paint.scan") == whole);
  CHECK(folder.entries() == 3);
  MESSAGE("lab scan, " << duration.count() << " s: " << killed << " of " << wanted_kills()
                       << " killed before their end, " << grown << " with a journal that was part of the whole; "
                       << begun_anew << " begun anew");
}
