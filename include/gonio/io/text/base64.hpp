#pragma once
/// Bytes as text: base64 (RFC 4648) and data URLs (RFC 2397).

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace gonio::io {

/// Returns the bytes in base64: four characters for each three bytes.
[[nodiscard]] std::string base64(std::span<const std::byte> bytes);

/// Returns `data:`, the media type and the bytes in base64.
[[nodiscard]] std::string data_url(std::string_view media_type, std::span<const std::byte> bytes);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/text/impl/base64.ipp>
#endif
