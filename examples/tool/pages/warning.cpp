#include "warning.hpp"

#include "elapsed_time.hpp"
#include <gonio/core/printable.hpp>

#include <iostream>
#include <set>

namespace cli {

void warn(const std::string& sentence) {
  // `gonio check` reads the reference again with each part: print its warnings once.
  static std::set<std::string> printed;
  if (!printed.insert(sentence).second) return;
  wipe_line();
  std::cerr << "gonio: warning: " << gonio::printable(sentence) << '\n';
}

}  // namespace cli
