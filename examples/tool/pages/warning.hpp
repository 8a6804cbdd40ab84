#pragma once
/// Warnings to the user about input that is accepted.

#include <string>

namespace cli {

/// Prints a line on standard error, "gonio: warning: ...", safe for a terminal even if it quotes a file.
/// The same sentence is printed once.
void warn(const std::string& sentence);

}  // namespace cli
