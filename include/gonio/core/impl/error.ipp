#pragma once
/// Bodies of core/error.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>

#include <cstdio>
#include <cstdlib>

namespace gonio {

namespace detail {

[[nodiscard]] GONIO_INLINE std::string joined(std::initializer_list<message_part> parts) {
  std::string sentence;
  for (const message_part& part : parts) sentence += part.str();
  return sentence;
}

}  // namespace detail

GONIO_INLINE std::string message_part::str() const {
  if (size_ == real) return std::to_string(real_);
  if (size_ == integer) return std::to_string(integer_);
  if (size_ == natural) return std::to_string(natural_);
  return {text_, size_};
}

GONIO_INLINE error::error(std::initializer_list<message_part> parts) : std::runtime_error(detail::joined(parts)) {}

GONIO_INLINE void refuse(const std::string& sentence) {
#if defined(__cpp_exceptions)
  throw error(sentence);
#else
  std::fprintf(stderr, "gonio: %s\n", sentence.c_str());
  std::abort();
#endif
}

}  // namespace gonio
