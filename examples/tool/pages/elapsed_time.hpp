#pragma once
/// Shows on a terminal that the tool is at work, where no fraction of the work is known.

#include <memory>
#include <string>

namespace cli {

/// While it lives, shows a stage and its seconds on standard error, from the second second on, if that is a terminal:
/// "reconstructing, 12 s". Wipes itself at its end. `warn` wipes it, too.
class elapsed_time {
 public:
  explicit elapsed_time(std::string stage);
  elapsed_time(const elapsed_time&) = delete;
  elapsed_time& operator=(const elapsed_time&) = delete;
  ~elapsed_time();

 private:
  class clock;
  std::unique_ptr<clock> clock_;  ///< none if nobody sees it
};

/// Clears the terminal's line on standard error, if standard error is a terminal.
void wipe_line();

}  // namespace cli
