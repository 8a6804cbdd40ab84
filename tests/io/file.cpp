#include "scratch.hpp"
#include <gonio/io/bytes/file.hpp>

#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <string>
#include <thread>

using gonio::io::file_writer;
using gonio::io::read_bytes;
using gonio::io::staging;
using gonio::io::write_atomically;
using scratch::bytes_of;
using scratch::check_refused;

namespace {

/// Limits the size of files while it exists, like a full disk.
class file_size_limit {
 public:
  explicit file_size_limit(rlim_t size) : old_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit small{size, old_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
  }
  file_size_limit(const file_size_limit&) = delete;
  file_size_limit& operator=(const file_size_limit&) = delete;
  ~file_size_limit() {
    setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, old_handler_);
  }

 private:
  void (*old_handler_)(int);
  rlimit old_{};
};

/// Makes root an ordinary user while it exists: permissions do not bind root.
class ordinary_user {
 public:
  ordinary_user() : was_root_(geteuid() == 0 && seteuid(65534) == 0) {}
  ordinary_user(const ordinary_user&) = delete;
  ordinary_user& operator=(const ordinary_user&) = delete;
  ~ordinary_user() {
    if (was_root_ && seteuid(0) != 0) std::abort();
  }

 private:
  bool was_root_;
};

/// Unmounts the disk in its destructor.
struct small_disk {
  const scratch::fs::path& folder;
  ~small_disk() { CHECK(::umount2(folder.c_str(), MNT_DETACH) == 0); }
};

/// Runs `work` in a child process; returns the signal that ended it, 0 if none did.
template <class Work>
int signal_that_ends(Work&& work) {
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    work();
    ::_exit(0);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

/// Writes part of a file, then raises the signal.
void write_half_and_die(const scratch::fs::path& path, staging held, int signal) {
  file_writer file(path, held);
  file.write(bytes_of(std::string(100'000, 'x')));
  ::raise(signal);
}

extern "C" void clean_up(int signal) {
  gonio::io::remove_unfinished_files();
  ::signal(signal, SIG_DFL);
  ::raise(signal);
}

std::string this_machine() {
  std::array<char, 65> name{};
  REQUIRE(::gethostname(name.data(), name.size() - 1) == 0);
  return name.data();
}

void permit(const scratch::fs::path& path, unsigned mode) {
  scratch::fs::permissions(path, static_cast<scratch::fs::perms>(mode));
}

}  // namespace

TEST_CASE("a file is read whole") {
  const scratch::folder here;
  for (const std::size_t size : {0u, 1u, 4096u, 1'000'003u}) {
    const std::string content(size, 'x');
    scratch::put(here / "a", content);
    CHECK(read_bytes(here / "a") == bytes_of(content));
  }
}

TEST_CASE("unreadable files are refused") {
  const scratch::folder here;
  check_refused([&] { return read_bytes(here / "absent"); }, {"absent", "cannot be read", "No such file"});
  check_refused([&] { return read_bytes(here.path()); }, {here.path().string(), "is a directory"});
  check_refused([] { return read_bytes("/dev/null"); }, {"/dev/null", "not a regular file"});
  check_refused([] { return read_bytes(""); }, {"No such file"});
  scratch::put(here / "secret", "x");
  permit(here.path(), 0755);
  permit(here / "secret", 0);
  const ordinary_user user;
  check_refused([&] { return read_bytes(here / "secret"); }, {"secret", "Permission denied"});
}

TEST_CASE("writing creates and replaces, and leaves nothing else behind") {
  const scratch::folder here;
  write_atomically(here / "a", bytes_of("one"));
  CHECK(scratch::get(here / "a") == "one");
  write_atomically(here / "a", [](file_writer& file) {
    file.write(bytes_of("two"));
    file.write({});
    file.write(bytes_of(" three"));
  });
  CHECK(scratch::get(here / "a") == "two three");
  CHECK(here.entries() == 1);
  write_atomically(here / std::string(255, 'n'), bytes_of("the longest name"));
  CHECK(here.entries() == 2);
}

TEST_CASE("a relative path without a folder is written") {
  const scratch::folder here;
  const auto before = scratch::fs::current_path();
  scratch::fs::current_path(here.path());
  write_atomically("a", bytes_of("one"));
  scratch::fs::current_path(before);
  CHECK(scratch::get(here / "a") == "one");
}

TEST_CASE("permissions of a replaced file are kept, a new one follows the umask") {
  const scratch::folder here;
  scratch::put(here / "a", "old");
  permit(here / "a", 0640);
  write_atomically(here / "a", bytes_of("new"));
  CHECK(scratch::fs::status(here / "a").permissions() == static_cast<scratch::fs::perms>(0640));
  const mode_t mask = umask(027);
  write_atomically(here / "b", bytes_of("new"));
  umask(mask);
  CHECK(scratch::fs::status(here / "b").permissions() == static_cast<scratch::fs::perms>(0640));
}

TEST_CASE("a symbolic link stays one") {
  const scratch::folder here;
  scratch::fs::create_directory(here / "elsewhere");
  scratch::fs::create_symlink("elsewhere/target", here / "link");
  write_atomically(here / "link", bytes_of("one"));
  write_atomically(here / "link", bytes_of("two"));
  CHECK(scratch::fs::is_symlink(here / "link"));
  CHECK(scratch::get(here / "elsewhere/target") == "two");
  scratch::fs::create_symlink("loop", here / "loop");
  check_refused(
      [&] {
        write_atomically(here / "loop", bytes_of("x"));
        return 0;
      },
      {"loop", "symbolic links"});
}

TEST_CASE("a failing callback leaves the old file whole") {
  const scratch::folder here;
  scratch::put(here / "a", "old");
  check_refused(
      [&] {
        write_atomically(here / "a", [](file_writer& file) {
          file.write(bytes_of("half"));
          throw gonio::error("changed my mind");
        });
        return 0;
      },
      {"changed my mind"});
  CHECK(scratch::get(here / "a") == "old");
  CHECK(here.entries() == 1);
}

TEST_CASE("an impossible target is refused") {
  const scratch::folder here;
  const auto write_to = [](const scratch::fs::path& path) {
    return [path] {
      write_atomically(path, bytes_of("new"));
      return 0;
    };
  };
  scratch::fs::create_directory(here / "folder");
  check_refused(write_to(here / "folder"), {"folder", "cannot be written", "is a directory"});
  check_refused(write_to(here / "absent" / "a"), {"absent/a", "cannot be written", "No such file"});
  check_refused(write_to(""), {"cannot be written"});
  scratch::put(here / "file", "x");
  check_refused(write_to(here / "file" / "a"), {"file/a", "Not a directory"});
  // As root, a rename would replace the device itself.
  scratch::fs::create_symlink("/dev/full", here / "device");
  check_refused(write_to(here / "device"), {"device", "not a regular file"});
  CHECK(scratch::fs::is_character_file("/dev/full"));
  CHECK(here.entries() == 3);
}

TEST_CASE("an unwritable target is refused and stays whole") {
  const scratch::folder here;
  scratch::put(here / "a", "old");
  permit(here.path(), 0555);
  permit(here / "a", 0666);
  {
    const ordinary_user user;
    check_refused(
        [&] {
          write_atomically(here / "a", bytes_of("new"));
          return 0;
        },
        {"a: cannot be written", "Permission denied"});
  }
  permit(here.path(), 0777);
  permit(here / "a", 0444);
  {
    const ordinary_user user;
    check_refused(
        [&] {
          write_atomically(here / "a", bytes_of("new"));
          return 0;
        },
        {"a: cannot be written", "Permission denied"});
  }
  permit(here.path(), 0755);
  CHECK(scratch::get(here / "a") == "old");
  CHECK(here.entries() == 1);
}

TEST_CASE("a file that grows too large leaves the old one whole") {
  const scratch::folder here;
  scratch::put(here / "a", "old");
  const std::vector<std::byte> large(1 << 20);
  {
    const file_size_limit limit(10'000);
    check_refused(
        [&] {
          write_atomically(here / "a", large);
          return 0;
        },
        {"a: cannot be written", "File too large"});
  }
  CHECK(scratch::get(here / "a") == "old");
  CHECK(here.entries() == 1);
}

TEST_CASE("a full disk leaves the old file whole") {
  const scratch::folder here;
  if (::mount("tmpfs", here.path().c_str(), "tmpfs", 0, "size=64k") != 0) {
    MESSAGE("skipped: a small disk can be mounted by root only");
    return;
  }
  const small_disk mounted{here.path()};
  scratch::put(here / "a", "old");
  const std::vector<std::byte> large(1 << 20);
  check_refused(
      [&] {
        write_atomically(here / "a", large);
        return 0;
      },
      {"a: cannot be written", "No space left on device"});
  CHECK(scratch::get(here / "a") == "old");
  CHECK(here.entries() == 1);
}

TEST_CASE("writers of one file do not disturb each other") {
  for (const staging held : {staging::unnamed, staging::named}) {
    const scratch::folder here;
    const auto write = [&](char letter) {
      for (int i = 0; i < 50; ++i) {
        file_writer file(here / "a", held);
        file.write(bytes_of(std::string(1000, letter)));
        file.commit();
      }
    };
    std::thread other(write, 'x');
    write('y');
    other.join();
    const std::string content = scratch::get(here / "a");
    CHECK((content == std::string(1000, 'x') || content == std::string(1000, 'y')));
    CHECK(here.entries() == 1);
  }
}

TEST_CASE("a process that is killed while it writes leaves nothing behind") {
  const scratch::folder here;
  scratch::put(here / "a", "old");
  CHECK(signal_that_ends([&] { write_half_and_die(here / "a", staging::unnamed, SIGKILL); }) == SIGKILL);
  CHECK(here.entries() == 1);
  CHECK(scratch::get(here / "a") == "old");
}

TEST_CASE("the next write into a folder removes the named files of killed processes") {
  const scratch::folder here;
  CHECK(signal_that_ends([&] { write_half_and_die(here / "a", staging::named, SIGKILL); }) == SIGKILL);
  CHECK(here.entries() == 1);
  write_atomically(here / "b", bytes_of("new"));
  CHECK(here.entries() == 1);
  CHECK(scratch::get(here / "b") == "new");
}

TEST_CASE("a signal handler removes named temporary files") {
  const scratch::folder here;
  const auto die_tidily = [&](int signal) {
    return [&, signal] {
      ::signal(signal, clean_up);
      write_half_and_die(here / "a", staging::named, signal);
    };
  };
  CHECK(signal_that_ends(die_tidily(SIGTERM)) == SIGTERM);
  CHECK(here.entries() == 0);
  CHECK(signal_that_ends(die_tidily(SIGINT)) == SIGINT);
  CHECK(here.entries() == 0);
}

TEST_CASE("a file that cannot be linked is copied") {
  const scratch::folder here;
  scratch::put(here / "a", "old");
  permit(here / "a", 0640);
  const std::string content(200'000, 'x');
  const auto write_where_no_link_is_made = [&] {
    // Linking an unnamed file needs /proc, which is unmounted before the commit.
    if (::unshare(CLONE_NEWNS) != 0 || ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) ::_exit(77);
    for (const char* name : {"a", "b"}) {
      file_writer file(here / name);
      file.write(bytes_of(content));
      if (name[0] == 'a' && ::umount2("/proc", MNT_DETACH) != 0) ::_exit(77);
      file.commit();
    }
  };
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    try {
      write_where_no_link_is_made();
      ::_exit(0);
    } catch (const gonio::error&) {
      ::_exit(1);
    }
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 77) {
    MESSAGE("skipped: a process without /proc can be made by root only");
    return;
  }
  CHECK(status == 0);
  CHECK(scratch::get(here / "a") == content);
  CHECK(scratch::get(here / "b") == content);
  CHECK(scratch::fs::status(here / "a").permissions() == static_cast<scratch::fs::perms>(0640));
  CHECK(here.entries() == 2);
}

TEST_CASE("only abandoned temporary files are removed") {
  const scratch::folder here;
  const std::string dead = std::to_string(2'000'000'000), other = std::to_string(::getppid());
  const auto name = [](const std::string& machine, const std::string& process) {
    return ".gonio-" + machine + process + "-0.tmp";
  };
  const std::string mine = this_machine() + "-";
  for (const std::string& left : {name(mine, dead), name("", dead), name(mine, std::to_string(::getpid()))})
    scratch::put(here / left, "left");
  const std::vector<std::string> kept{name(mine, other), name("another-machine-", dead), ".gonio-notes.tmp",
                                      ".gonio-x-1.tmp", "gonio-" + dead + "-0.tmp"};
  for (const std::string& each : kept) scratch::put(here / each, "kept");
  file_writer unfinished(here / "b", staging::named);  // by this process, which still runs
  write_atomically(here / "a", bytes_of("new"));
  CHECK(here.entries() == kept.size() + 2);
  for (const std::string& each : kept) CHECK(scratch::fs::exists(here / each));
  unfinished.commit();
  CHECK(here.entries() == kept.size() + 2);
}

TEST_CASE("named temporary files give the same result as unnamed ones") {
  const scratch::folder here;
  for (const std::string content : {"one", "two"}) {
    file_writer file(here / "a", staging::named);
    file.write(bytes_of(content));
    file.commit();
    CHECK(scratch::get(here / "a") == content);
    CHECK(here.entries() == 1);
  }
  { file_writer(here / "a", staging::named).write(bytes_of("half")); }
  CHECK(scratch::get(here / "a") == "two");
  CHECK(here.entries() == 1);
}
