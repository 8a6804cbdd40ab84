#include "elapsed_time.hpp"

#include <gonio/core/printable.hpp>

#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>

namespace cli {

namespace {

bool is_seen() { return ::isatty(STDERR_FILENO) != 0; }

}  // namespace

/// A thread that draws once a second until it is asked to stop.
class elapsed_time::clock {
 public:
  explicit clock(std::string stage)
      : stage_(gonio::printable(stage)), thread_([this](const std::stop_token& stop) { run(stop); }) {}

 private:
  void run(const std::stop_token& stop) {
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any ticks;
    for (int seconds = 1;; ++seconds) {
      ticks.wait_for(lock, stop, std::chrono::seconds(1), [] { return false; });
      if (stop.stop_requested()) break;
      if (seconds > 1) std::fprintf(stderr, "\r\033[K%s, %d s", stage_.c_str(), seconds);
    }
    wipe_line();
  }

  std::string stage_;
  std::jthread thread_;  // stops and joins first
};

elapsed_time::elapsed_time(std::string stage) {
  if (is_seen()) clock_ = std::make_unique<clock>(std::move(stage));
}

elapsed_time::~elapsed_time() = default;

void wipe_line() {
  if (is_seen()) std::fputs("\r\033[K", stderr);
}

}  // namespace cli
