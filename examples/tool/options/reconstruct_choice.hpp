#pragma once
/// The methods of `gonio reconstruct` by name, their options, and the steps after every fit.

#include "reconstruct_methods.hpp"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace cli {

struct reconstruct_method {
  const char* name;
  const char* description;
  reconstruction (*reconstruct)(const reconstruct_options&, const gonio::sample_set&);
  /// The options that only some methods take.
  std::vector<std::string_view> takes;
};

[[nodiscard]] const std::vector<reconstruct_method>& reconstruct_methods();

/// Refuses options that the method of `options` would ignore, naming the methods that take them, and notes whether any
/// of the method's own options is given. `is_given` is called with options such as "--noise". Throws gonio::error for
/// such options, and for an unknown method.
void take_given(reconstruct_options& options, const std::function<bool(const std::string&)>& is_given);

/// Reconstructs with the method of `options`; if wavelengths are kept, each is a grey material. Warns of samples and
/// methods with likely poor results. Throws gonio::error for unusable samples, and if the table is not finite.
[[nodiscard]] reconstruction reconstruct(const reconstruct_options& options, const gonio::sample_set& samples);

}  // namespace cli
