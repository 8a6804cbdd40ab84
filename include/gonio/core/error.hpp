#pragma once
/// The one exception type of the library: bad input, refused at the edge.

#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace gonio {

/// Thrown when data that came from outside (a file, a caller's array, a command line) is not what it
/// should be. The message is one sentence that names what is wrong, where, and what was expected.
/// Evaluating a BRDF never throws.
class error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws gonio::error. In a program that is compiled without exceptions, as renderers may be, it prints the sentence
/// to the standard error stream and aborts.
[[noreturn]] inline void refuse(const std::string& sentence) {
#if defined(__cpp_exceptions)
  throw error(sentence);
#else
  std::fprintf(stderr, "gonio: %s\n", sentence.c_str());
  std::abort();
#endif
}

}  // namespace gonio
