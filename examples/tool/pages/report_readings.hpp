#pragma once
/// What instruments would read of a fit, and how well that is known.

#include "tool/files/json.hpp"
#include <gonio/table/brdf_table.hpp>

namespace cli {

/// Of a fit whose uncertainty is relative: each reading's, with the keys of `to_json(instrument_readings)`. Of gloss,
/// haze and colours it is that of light at the source's centre and a viewer at the receptor's, of reflectance what it
/// would be off by if all directions were off together.
[[nodiscard]] json readings_known_to(const gonio::brdf_table& fit, const gonio::brdf_table& uncertainty);

}  // namespace cli
