#pragma once
/// Distant lights on the command line.

#include "command.hpp"
#include <gonio/render/lighting.hpp>

#include <string>
#include <vector>

namespace cli {

/// Adds `--light`, repeatable: degrees to the right of the camera and above it.
option add_light_option(command& to, std::vector<std::string>& lights);

/// Returns the given lights, or the two lights of Nielsen et al. 2015, Figure 2. Throws gonio::error naming the text
/// that is not a pair of angles.
[[nodiscard]] gonio::render::directional_lighting lighting_of(const std::vector<std::string>& lights);

}  // namespace cli
