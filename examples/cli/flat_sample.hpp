#pragma once
/// Images of a flat sample whose BRDF a map has: seen from straight ahead, under distant lights.

#include <gonio/basis/pca.hpp>
#include <gonio/core/directional_light.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/io/svbrdf_map.hpp>
#include <gonio/table/image.hpp>

#include <filesystem>
#include <optional>
#include <span>

namespace cli {

/// Radiance times pi in a pixel for each texel; lights are in the camera's axes, x to the right, y up, z towards it.
/// Throws gonio::error if the map is of another prior, or is damaged.
[[nodiscard]] gonio::image flat_sample_radiance(const gonio::io::svbrdf_map& map, const gonio::log_relative_pca& prior,
                                                std::span<const gonio::directional_light> lights,
                                                gonio::thread_count threads);

/// The image of a map with an exposure, which is what a white Lambertian surface that faces a light of irradiance 1
/// has; by default `render::exposure_of` it. Throws gonio::error as `flat_sample_radiance` does.
[[nodiscard]] gonio::image flat_sample_image(const std::filesystem::path& map, const std::filesystem::path& prior,
                                             std::span<const gonio::directional_light> lights,
                                             std::optional<double> exposure, gonio::thread_count threads);

}  // namespace cli
