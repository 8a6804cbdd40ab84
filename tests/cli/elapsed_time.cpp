/// Progress shown in a terminal if the fraction of work done is unknown.

#include "tool/pages/elapsed_time.hpp"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>

namespace {

/// Returns the standard error of a child process that works for some milliseconds, in a terminal or a pipe.
std::string shown(bool on_terminal, int milliseconds) {
  std::array<int, 2> ends{};  // to read, to write
  if (on_terminal) {
    ends[0] = ::posix_openpt(O_RDWR | O_NOCTTY);
    REQUIRE((ends[0] >= 0 && ::grantpt(ends[0]) == 0 && ::unlockpt(ends[0]) == 0));
    ends[1] = ::open(::ptsname(ends[0]), O_RDWR | O_NOCTTY);
  } else {
    REQUIRE(::pipe(ends.data()) == 0);
  }
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    ::dup2(ends[1], STDERR_FILENO);
    {
      const cli::elapsed_time waiting("measuring");
      std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    }
    ::_exit(0);
  }
  ::waitpid(child, nullptr, 0);
  if (on_terminal) ::fcntl(ends[0], F_SETFL, O_NONBLOCK);  // this process keeps the other end open
  if (!on_terminal) ::close(ends[1]);
  std::string text;
  std::array<char, 256> buffer{};
  for (ssize_t count = 0; (count = ::read(ends[0], buffer.data(), buffer.size())) > 0;)
    text.append(buffer.data(), static_cast<std::size_t>(count));
  ::close(ends[0]);
  if (on_terminal) ::close(ends[1]);
  return text;
}

}  // namespace

TEST_CASE("work of over two seconds shows its stage on a terminal, and wipes it") {
  const std::string text = shown(true, 2500);
  CHECK(text.find("measuring, 2 s") != std::string::npos);
  CHECK(text.ends_with("\r\033[K"));
  CHECK(shown(true, 200).find("measuring") == std::string::npos);
  CHECK(shown(false, 2500).empty());
}
