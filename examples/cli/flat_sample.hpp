#pragma once
/// Images of a flat sample whose BRDF a map has: seen from straight ahead, under distant lights.

#include <gonio/core/directional_light.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/table/image.hpp>

#include <filesystem>
#include <optional>
#include <span>

namespace cli {

/// An image of a pixel for each texel; lights are in the camera's axes, x to the right, y up, z towards it. `exposure`
/// is what a white Lambertian surface that faces a light of irradiance 1 has; by default the image is white at the 99th
/// percentile of what is not black, as texels are that are not of the sample. Throws gonio::error if the map is of another prior, or is damaged.
[[nodiscard]] gonio::image flat_sample_image(const std::filesystem::path& map, const std::filesystem::path& prior,
                                             std::span<const gonio::directional_light> lights,
                                             std::optional<double> exposure, gonio::thread_count threads);

}  // namespace cli
