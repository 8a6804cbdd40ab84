#pragma once
/// Progress reports of long computations.

#include <functional>
#include <string_view>

namespace gonio {

/// Called repeatedly by long computations, with the name of the stage and its completed fraction, from 0 to 1, from one
/// thread at a time. An empty function receives no reports.
using progress = std::function<void(std::string_view stage, double fraction)>;

/// Reports unless the listener is empty.
inline void report(const progress& listener, std::string_view stage, double fraction) {
  if (listener) listener(stage, fraction);
}

}  // namespace gonio
