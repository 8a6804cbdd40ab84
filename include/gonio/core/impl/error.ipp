#pragma once
/// Bodies of core/error.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/printable.hpp>

#include <array>
#include <cstdio>
#include <cstdlib>

namespace gonio {

[[gnu::cold]] GONIO_INLINE void message_part::append_to(std::string& sentence) const {
  // The longest double has 309 digits before its point.
  std::array<char, 400> digits;
  int count = -1;
  if (size_ == real) count = std::snprintf(digits.data(), digits.size(), "%f", real_);
  if (size_ == integer) count = std::snprintf(digits.data(), digits.size(), "%lld", integer_);
  if (size_ == natural) count = std::snprintf(digits.data(), digits.size(), "%llu", natural_);
  if (count < 0)
    sentence.append(text_, size_);
  else
    sentence.append(digits.data(), count);
}

[[gnu::cold]] GONIO_INLINE std::string message_of(std::initializer_list<message_part> parts) {
  std::string sentence;
  for (const message_part& part : parts) part.append_to(sentence);
  return sentence;
}

[[gnu::cold]] GONIO_INLINE error::error(const std::string& sentence) : std::runtime_error(printable(sentence)) {}

[[gnu::cold]] GONIO_INLINE void refuse(const std::string& sentence) {
#if defined(__cpp_exceptions)
  throw error(sentence);
#else
  std::fprintf(stderr, "gonio: %s\n", sentence.c_str());
  std::abort();
#endif
}

[[gnu::cold]] GONIO_INLINE void refuse(std::initializer_list<message_part> parts) { refuse(message_of(parts)); }

}  // namespace gonio
