#pragma once
/// The library's measures, under their documented keys.

#include "tool/files/json.hpp"
#include <gonio/core/rgb.hpp>

namespace gonio {
struct comparison;
namespace model {
struct instrument_readings;
}
}  // namespace gonio

namespace cli {

/// Returns three numbers as an array.
[[nodiscard]] json per_channel(const gonio::rgb& values);

/// Returns the errors under the keys that `gonio compare --json` documents.
[[nodiscard]] json to_json(const gonio::comparison& errors);

/// Returns the readings of gloss meters, integrating spheres and multi-angle instruments. The keys contain the angles.
[[nodiscard]] json to_json(const gonio::model::instrument_readings& readings);

}  // namespace cli
