#pragma once
/// The library's measures, under their documented keys.

#include "tool/files/json.hpp"
#include <gonio/core/rgb.hpp>

namespace gonio {
struct comparison;
}

namespace cli {

/// Returns three numbers as an array.
[[nodiscard]] json per_channel(const gonio::rgb& values);

/// Returns the keys that `gonio compare --json` documents.
[[nodiscard]] json to_json(const gonio::comparison& errors);

}  // namespace cli
