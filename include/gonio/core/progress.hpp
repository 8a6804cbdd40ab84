#pragma once
/// How long work tells its caller how far it has come.

#include <functional>
#include <string_view>

namespace gonio {

/// Called now and then by long work with the name of its stage and the fraction of that stage that is
/// done, from 0 to 1, from one thread at a time. An empty function asks for no reports.
using progress = std::function<void(std::string_view stage, double fraction)>;

/// Reports if anyone listens.
inline void report(const progress& listener, std::string_view stage, double fraction) {
  if (listener) listener(stage, fraction);
}

}  // namespace gonio
