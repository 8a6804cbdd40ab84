#include "warning.hpp"

#include <gonio/core/printable.hpp>

#include <iostream>

namespace cli {

void warn(const std::string& sentence) { std::cerr << "gonio: warning: " << gonio::printable(sentence) << '\n'; }

}  // namespace cli
