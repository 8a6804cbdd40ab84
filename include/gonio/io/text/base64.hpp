#pragma once
/// Bytes within texts: base64 (RFC 4648), and URLs that hold what they name (RFC 2397).

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace gonio::io {

/// O(n): four letters for each three bytes.
[[nodiscard]] std::string base64(std::span<const std::byte> bytes);

/// `data:`, the media type and the bytes.
[[nodiscard]] std::string data_url(std::string_view media_type, std::span<const std::byte> bytes);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/text/impl/base64.ipp>
#endif
