#include "warning.hpp"

#include "elapsed_time.hpp"
#include <gonio/core/printable.hpp>

#include <iostream>

namespace cli {

void warn(const std::string& sentence) {
  wipe_line();
  std::cerr << "gonio: warning: " << gonio::printable(sentence) << '\n';
}

}  // namespace cli
