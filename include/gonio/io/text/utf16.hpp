#pragma once
/// Text in UTF-16: Excel's "Unicode text" and the files of some instruments.

#include <string>
#include <string_view>

namespace gonio::io {

/// Does the text begin with a byte order mark of UTF-16, or with two ASCII letters in UTF-16?
[[nodiscard]] bool is_utf16(std::string_view text) noexcept;

/// Converts UTF-16 to UTF-8 without the mark. Invalid code units become U+FFFD. O(length).
[[nodiscard]] std::string utf8_of_utf16(std::string_view text);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/text/impl/utf16.ipp>
#endif
