#pragma once
/// Tables in the format of a page's viewer (docs/reference/formats.md).

#include "tool/files/json.hpp"
#include <gonio/table/brdf_table.hpp>

namespace cli {

/// Returns values as half floats without the last two bits, within 0.25 %; negative values become 0. Stores each
/// channel's differences along phi_d, deflated: 1 to 1.5 MB of text. O(cells). Throws gonio::error if a value is not
/// finite.
[[nodiscard]] json viewer_table(const gonio::brdf_table& table);

/// Returns the relative uncertainty of the green channel at every second cell along each axis, one byte each: 0.1 % to
/// 1000 % on a logarithmic scale of 255 equal steps, compressed by deflate. O(cells).
[[nodiscard]] json viewer_uncertainty(const gonio::brdf_table& relative);

}  // namespace cli
