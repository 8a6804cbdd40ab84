#pragma once
/// The one exception type of the library: bad input, refused at the edge.

#include <stdexcept>

namespace gonio {

/// Thrown when data that came from outside (a file, a caller's array, a command line) is not what it
/// should be. The message is one sentence that names what is wrong, where, and what was expected.
/// Evaluating a BRDF never throws.
class error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace gonio
