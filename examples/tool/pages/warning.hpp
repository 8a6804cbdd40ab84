#pragma once
/// What a user is told of input that is accepted all the same.

#include <string>

namespace cli {

/// A line on standard error, "gonio: warning: ...", fit for a terminal whatever a file's text is in it.
void warn(const std::string& sentence);

}  // namespace cli
