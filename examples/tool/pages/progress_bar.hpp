#pragma once
/// A progress bar on the terminal, for work that takes over a second.

#include <gonio/core/printable.hpp>
#include <gonio/core/progress.hpp>

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <string>

namespace cli {

/// Draws on standard error if it is a terminal and the work has taken over a second; wipes itself at the end.
class progress_bar {
 public:
  progress_bar() = default;
  progress_bar(const progress_bar&) = delete;
  progress_bar& operator=(const progress_bar&) = delete;
  ~progress_bar() { wipe(); }

  /// Clears the line, before results are printed.
  void wipe() {
    if (drawn_) std::fputs("\r\033[K", stderr);
    drawn_ = false;
  }

  void draw(std::string_view stage, double fraction) {
    using namespace std::chrono_literals;
    const auto now = std::chrono::steady_clock::now();
    if (!terminal_ || now - start_ < 1s || now - last_ < 100ms) return;
    last_ = now;
    drawn_ = true;
    constexpr int width = 30;
    const int done = static_cast<int>(fraction * width);
    const std::string bar = std::string(done, '#') + std::string(width - done, '.');
    std::fprintf(stderr, "\r\033[K%s %3.0f %% %s", bar.c_str(), 100.0 * fraction, gonio::printable(stage).c_str());
  }

  /// Returns the library's callback; the bar must outlive it.
  [[nodiscard]] gonio::progress listener() {
    return [this](std::string_view stage, double fraction) { draw(stage, fraction); };
  }

 private:
  bool terminal_ = isatty(STDERR_FILENO) != 0;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_{};
};

}  // namespace cli
