#pragma once
/// Distant lights as the command line gives them.

#include "command.hpp"
#include <gonio/render/lighting.hpp>

#include <string>
#include <vector>

namespace cli {

/// Adds `--light`: degrees to the right of the camera and above it, any number of times.
option add_light_option(command& to, std::vector<std::string>& lights);

/// The lights that were given, or the two lights of Nielsen et al. 2015, Figure 2. Throws gonio::error naming what is
/// no pair of angles.
[[nodiscard]] gonio::render::directional_lighting lighting_of(const std::vector<std::string>& lights);

}  // namespace cli
