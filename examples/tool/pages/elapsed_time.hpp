#pragma once
/// Shows on a terminal that the tool is at work, where no fraction of the work is known.

#include <memory>
#include <string>

namespace cli {

/// Shows a stage and its duration while the object lives: "reconstructing, 12 s". Draws on standard error if that is a
/// terminal, from two seconds on. The destructor and `warn` wipe the line.
class elapsed_time {
 public:
  explicit elapsed_time(std::string stage);
  elapsed_time(const elapsed_time&) = delete;
  elapsed_time& operator=(const elapsed_time&) = delete;
  ~elapsed_time();

 private:
  class clock;
  std::unique_ptr<clock> clock_;  ///< null if standard error is no terminal
};

/// Clears the terminal's line on standard error, if standard error is a terminal.
void wipe_line();

}  // namespace cli
