#pragma once
/// The only exception type of the library, for bad input.

#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>

namespace gonio {

/// A piece of a message: text, or a number, formatted as by std::to_string. Refers to the given text without copying
/// it.
class message_part {
 public:
  message_part(std::string_view text) : text_(text.data()), size_(text.size()) {}                // NOLINT: implicit
  message_part(const char* text) : message_part(std::string_view(text)) {}                       // NOLINT
  message_part(const std::string& text) : message_part(std::string_view(text)) {}                // NOLINT
  message_part(double number) : real_(number), size_(real) {}                                    // NOLINT
  message_part(long long number) : integer_(number), size_(integer) {}                           // NOLINT
  message_part(unsigned long long number) : natural_(number), size_(natural) {}                  // NOLINT
  message_part(int number) : message_part(static_cast<long long>(number)) {}                     // NOLINT
  message_part(long number) : message_part(static_cast<long long>(number)) {}                    // NOLINT
  message_part(unsigned number) : message_part(static_cast<unsigned long long>(number)) {}       // NOLINT
  message_part(unsigned long number) : message_part(static_cast<unsigned long long>(number)) {}  // NOLINT

  void append_to(std::string& sentence) const;

 private:
  // Values of size_ that mark numbers. They are larger than the length of any text.
  static constexpr std::size_t real = std::string_view::npos, integer = real - 1, natural = real - 2;

  union {
    const char* text_;
    double real_;
    long long integer_;
    unsigned long long natural_;
  };
  std::size_t size_;  ///< the text's size, or the kind of number
};

/// Returns the joined parts.
[[nodiscard]] std::string message_of(std::initializer_list<message_part> parts);

/// Thrown if external data (a file, a caller's array, a command line) is invalid. The message is one sentence that
/// names the fault, its location, and the expected value. Evaluating a BRDF never throws. Code that refuses input calls
/// `refuse`.
class error : public std::runtime_error {
 public:
  /// The sentence may contain text from a file: control characters are escaped (`printable`).
  explicit error(const std::string& sentence);
};

/// Throws gonio::error. In a program compiled without exceptions, as renderers may be, prints the sentence to the
/// standard error stream and aborts.
///
/// ```cpp
/// if (found != expected) gonio::refuse({"row ", row, " has ", found, " values, expected ", expected});
/// ```
[[noreturn]] void refuse(const std::string& sentence);
/// Joins the parts into a sentence, and throws gonio::error or aborts. Joining the parts here keeps the callers' code
/// small.
[[noreturn]] void refuse(std::initializer_list<message_part> parts);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/core/impl/error.ipp>
#endif
