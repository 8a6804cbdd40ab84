#pragma once
/// What the library measures, with the keys that are documented.

#include "tool/files/json.hpp"
#include <gonio/core/rgb.hpp>

namespace gonio {
struct comparison;
}

namespace cli {

/// Three numbers as an array.
[[nodiscard]] json per_channel(const gonio::rgb& values);

/// The keys that `gonio compare --json` documents.
[[nodiscard]] json to_json(const gonio::comparison& errors);

}  // namespace cli
