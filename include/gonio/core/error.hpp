#pragma once
/// The one exception type of the library: bad input, refused at the edge.

#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>

namespace gonio {

/// A piece of a message: text, or a number written as std::to_string does. It views the text that it is given.
class message_part {
 public:
  message_part(std::string_view text) : text_(text.data()), size_(text.size()) {}           // NOLINT: conversions are
  message_part(const char* text) : message_part(std::string_view(text)) {}                  // NOLINT: the point
  message_part(const std::string& text) : message_part(std::string_view(text)) {}           // NOLINT
  message_part(double number) : real_(number), size_(real) {}                               // NOLINT
  message_part(long long number) : integer_(number), size_(integer) {}                      // NOLINT
  message_part(unsigned long long number) : natural_(number), size_(natural) {}             // NOLINT
  message_part(int number) : message_part(static_cast<long long>(number)) {}                // NOLINT
  message_part(long number) : message_part(static_cast<long long>(number)) {}               // NOLINT
  message_part(unsigned number) : message_part(static_cast<unsigned long long>(number)) {}  // NOLINT
  message_part(unsigned long number) : message_part(static_cast<unsigned long long>(number)) {}  // NOLINT

  void append_to(std::string& sentence) const;

 private:
  // What no text is as long as.
  static constexpr std::size_t real = std::string_view::npos, integer = real - 1, natural = real - 2;

  union {
    const char* text_;
    double real_;
    long long integer_;
    unsigned long long natural_;
  };
  std::size_t size_;  ///< of the text, or which number it is
};

/// The parts, one after the other.
[[nodiscard]] std::string message_of(std::initializer_list<message_part> parts);

/// Thrown when data that came from outside (a file, a caller's array, a command line) is not what it
/// should be. The message is one sentence that names what is wrong, where, and what was expected.
/// Evaluating a BRDF never throws. Who refuses input calls `refuse`.
class error : public std::runtime_error {
 public:
  /// What a file held may stand in the sentence: control characters are escaped (`printable`).
  explicit error(const std::string& sentence);
};

/// Throws gonio::error. In a program that is compiled without exceptions, as renderers may be, it prints the sentence
/// to the standard error stream and aborts.
///
/// ```cpp
/// if (found != expected) gonio::refuse({"row ", row, " has ", found, " values, expected ", expected});
/// ```
[[noreturn]] void refuse(const std::string& sentence);
/// The parts are put together there, where it costs the caller no code of its own.
[[noreturn]] void refuse(std::initializer_list<message_part> parts);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/core/impl/error.ipp>
#endif
