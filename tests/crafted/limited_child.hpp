#pragma once
/// Runs a reader in a process of its own that may take so much memory and time, and no more.

#include "../fuzz/harness.hpp"
#include "../sanitized.hpp"

#include <doctest/doctest.h>
#include <malloc.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <new>
#include <string>

namespace crafted {

#if defined(__OPTIMIZE__)
inline constexpr bool optimised = true;
#else
inline constexpr bool optimised = false;
#endif

/// Beyond twice the file.
inline constexpr std::size_t memory_limit = std::size_t{64} << 20;
inline constexpr double seconds_limit = 2.0;

enum class outcome : int { read = 0, refused = 11, fault = 12, out_of_memory = 13, other_exception = 14 };

struct report {
  outcome how = outcome::fault;
  std::string message;
  double seconds = 0.0;
};

/// Of the whole address space, which is what the system can limit.
[[nodiscard]] inline std::size_t address_space() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * ::sysconf(_SC_PAGESIZE);
}

/// What the child does. stb says only in words that it got no memory.
[[nodiscard]] inline report read_here(const fuzz::reader& reader, fuzz::input bytes) {
  try {
    reader.read(bytes);
    return {outcome::read, ""};
  } catch (const gonio::error& refusal) {
    const std::string message = refusal.what(), fault = fuzz::fault_of(refusal);
    if (message.find("outofmem") != std::string::npos || message.find("memory") != std::string::npos)
      return {outcome::out_of_memory, message};
    return fault.empty() ? report{outcome::refused, message} : report{outcome::fault, fault};
  } catch (const std::bad_alloc&) {
    return {outcome::out_of_memory, "bad_alloc"};
  } catch (const std::exception& other) {
    return {outcome::other_exception, other.what()};
  }
}

[[noreturn]] inline void be_child(const fuzz::reader& reader, fuzz::input bytes, int pipe) {
  // A sanitizer's own address space is without bounds, and it slows down what it watches.
  if (!sanitized) {
    // Freed memory goes back to the system, so that only what is held at a time counts.
    ::mallopt(M_MMAP_THRESHOLD, 128 << 10);
    ::mallopt(M_TRIM_THRESHOLD, 128 << 10);
    ::malloc_trim(0);
    const rlimit memory{address_space() + 2 * bytes.size() + memory_limit, RLIM_INFINITY};
    ::setrlimit(RLIMIT_AS, &memory);
  }
  const unsigned patience = sanitized || !optimised ? 120 : 20;
  ::alarm(patience);
  for (const int crash : {SIGSEGV, SIGABRT, SIGFPE, SIGILL, SIGBUS}) ::signal(crash, SIG_DFL);
  const report result = read_here(reader, bytes);
  if (::write(pipe, result.message.data(), std::min<std::size_t>(result.message.size(), 4000)) < 0) ::_exit(1);
  ::_exit(static_cast<int>(result.how));
}

/// Fails where the reader crashes, throws what is no gonio::error, or takes more than twice the file and 64 MiB, or
/// two seconds.
inline report read_in_child(const fuzz::reader& reader, fuzz::input bytes) {
  std::array<int, 2> pipe{};
  REQUIRE(::pipe(pipe.data()) == 0);
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) be_child(reader, bytes, pipe[1]);
  ::close(pipe[1]);
  report result;
  std::array<char, 4096> text{};
  for (ssize_t count = 0; (count = ::read(pipe[0], text.data(), text.size())) > 0;)
    result.message.append(text.data(), count);
  ::close(pipe[0]);
  int status = 0;
  rusage used{};
  REQUIRE(::wait4(child, &status, 0, &used) == child);
  // The processor's: a machine that does other things is not the reader's fault. What waits, the alarm ends.
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  result.seconds = seconds(used.ru_utime) + seconds(used.ru_stime);
  INFO(reader.name << ", " << bytes.size() << " bytes: " << result.message);
  REQUIRE_MESSAGE(WIFEXITED(status), "signal ", WTERMSIG(status));
  result.how = static_cast<outcome>(WEXITSTATUS(status));
  CHECK(result.how != outcome::out_of_memory);
  CHECK_MESSAGE((result.how == outcome::read || result.how == outcome::refused), WEXITSTATUS(status));
  if (!sanitized && optimised) CHECK(result.seconds < seconds_limit);
  return result;
}

[[nodiscard]] inline const fuzz::reader& reader_named(const std::string& name) {
  for (const fuzz::reader& each : fuzz::readers())
    if (each.name == name) return each;
  throw std::logic_error("no harness is called " + name);
}

}  // namespace crafted
