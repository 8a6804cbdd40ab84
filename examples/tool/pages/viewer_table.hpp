#pragma once
/// Tables as the viewer of a page reads them (docs/reference/formats.md).

#include "tool/files/json.hpp"
#include <gonio/table/brdf_table.hpp>

namespace cli {

/// Values as half floats of which two bits are dropped, within 0.25 % of what they were, and negative ones as zero; of
/// each channel the differences along phi_d, deflated: 1 to 1.5 MB of text. O(cells). Throws gonio::error if a value is
/// not finite.
[[nodiscard]] json viewer_table(const gonio::brdf_table& table);

/// Relative uncertainties of the green channel at every second cell of each axis, in 255 equal steps of their logarithm
/// from 0.1 to 1000 %, deflated. O(cells).
[[nodiscard]] json viewer_uncertainty(const gonio::brdf_table& relative);

}  // namespace cli
