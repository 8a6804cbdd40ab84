#include "elapsed_time.hpp"

#include <gonio/core/printable.hpp>

#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <thread>
#include <utility>

namespace cli {

namespace {

bool is_seen() { return ::isatty(STDERR_FILENO) != 0; }

}  // namespace

/// A thread that draws once a second until it is destroyed.
class elapsed_time::clock {
 public:
  explicit clock(std::string stage) : stage_(gonio::printable(stage)), thread_([this] { run(); }) {}
  clock(const clock&) = delete;
  clock& operator=(const clock&) = delete;

  ~clock() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    ends_.notify_one();
    thread_.join();
  }

 private:
  void run() {
    std::unique_lock lock(mutex_);
    for (int seconds = 1; !ends_.wait_for(lock, std::chrono::seconds(1), [this] { return ended_; }); ++seconds)
      if (seconds > 1) std::fprintf(stderr, "\r\033[K%s, %d s", stage_.c_str(), seconds);
    wipe_line();
  }

  std::string stage_;
  std::mutex mutex_;
  std::condition_variable ends_;
  bool ended_ = false;
  // The last member: it starts when all others exist. std::jthread is experimental in libc++.
  std::thread thread_;
};

elapsed_time::elapsed_time(std::string stage) {
  if (is_seen()) clock_ = std::make_unique<clock>(std::move(stage));
}

elapsed_time::~elapsed_time() = default;

void wipe_line() {
  if (is_seen()) std::fputs("\r\033[K", stderr);
}

}  // namespace cli
