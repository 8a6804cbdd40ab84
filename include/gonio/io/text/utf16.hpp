#pragma once
/// Text in UTF-16, which Excel writes as "Unicode text" and some instruments write.

#include <string>
#include <string_view>

namespace gonio::io {

/// Does it begin with a byte order mark of UTF-16, or with two letters of it?
[[nodiscard]] bool is_utf16(std::string_view text) noexcept;

/// The same text in UTF-8, without the mark. What is no letter becomes U+FFFD. O(length).
[[nodiscard]] std::string utf8_of_utf16(std::string_view text);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/text/impl/utf16.ipp>
#endif
