#pragma once
/// Makes text of unknown origin safe for a terminal: text from a file must not control the terminal that shows it.

#include <string>
#include <string_view>

namespace gonio {

/// Returns the text with every control character (C0, DEL, C1) and every byte that is not UTF-8 written in hexadecimal,
/// such as `\x1b`. Other text is unchanged. gonio::error passes its sentence through this function.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/core/impl/printable.ipp>
#endif
