#pragma once
/// The methods of `gonio reconstruct` by name: which options each takes, and what all of them do after the fit.

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
  /// Those options that not all methods take.
  std::vector<std::string_view> takes;
};

[[nodiscard]] const std::vector<reconstruct_method>& reconstruct_methods();

/// Refuses options that the method of `options` would ignore, naming the methods that would not, and notes whether it
/// has options of its own. `is_given` is asked for options such as "--noise". Throws gonio::error for these, and for a
/// method that does not exist.
void take_given(reconstruct_options& options, const std::function<bool(const std::string&)>& is_given);

/// Reconstructs by the method of `options`, each wavelength as a grey material where they are kept, and warns of
/// samples and methods that are likely to disappoint. Throws gonio::error for unusable samples, and if the table is not
/// finite.
[[nodiscard]] reconstruction reconstruct(const reconstruct_options& options, const gonio::sample_set& samples);

}  // namespace cli
