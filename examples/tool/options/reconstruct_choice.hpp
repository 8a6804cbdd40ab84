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

/// Sets `has_own_options`. Throws gonio::error for an unknown method, and for an option that the method would ignore;
/// the error names the methods that take the option. `is_given` is called with option names such as "--noise".
void take_given(reconstruct_options& options, const std::function<bool(const std::string&)>& is_given);

/// Reconstructs with the method of `options`. If wavelengths are kept, each is fitted like a grey material. Warns if
/// the samples or the method are likely to give poor results. Throws gonio::error for unusable samples, and if the
/// table is not finite.
[[nodiscard]] reconstruction reconstruct(const reconstruct_options& options, const gonio::sample_set& samples);

}  // namespace cli
