#pragma once
/// Text of unknown origin made fit for a terminal: what a file holds must not steer the terminal that shows it.

#include <string>
#include <string_view>

namespace gonio {

/// The text with every control character (C0, DEL, C1) and every byte that is no UTF-8 written as `\x1b`. Text without
/// these comes back as it is. The sentence of every gonio::error has passed through it.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/core/impl/printable.ipp>
#endif
