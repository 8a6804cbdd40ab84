#pragma once
/// The uncertainty of instrument readings of a fit.

#include "tool/files/json.hpp"
#include <gonio/table/brdf_table.hpp>

namespace cli {

/// Returns the relative uncertainty of each reading, with the keys of `to_json(instrument_readings)`, from the relative
/// uncertainty of the fit. For gloss, haze and colours, this is the fit's uncertainty at the centres of source and
/// receptor; for reflectance, the error if all directions are off by their uncertainty at once.
[[nodiscard]] json readings_known_to(const gonio::brdf_table& fit, const gonio::brdf_table& uncertainty);

}  // namespace cli
