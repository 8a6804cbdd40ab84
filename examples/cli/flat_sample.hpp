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

/// The exposure with which an image is white at the 99th percentile of its pixels' largest values that are not black; 1
/// if all are.
[[nodiscard]] double exposure_of(const gonio::image& radiance);

/// The image of a map with an exposure. `exposure`
/// is what a white Lambertian surface that faces a light of irradiance 1 has; by default the image is white at the 99th
/// percentile of what is not black, as texels are that are not of the sample. Throws gonio::error as
/// `flat_sample_radiance` does.
[[nodiscard]] gonio::image flat_sample_image(const std::filesystem::path& map, const std::filesystem::path& prior,
                                             std::span<const gonio::directional_light> lights,
                                             std::optional<double> exposure, gonio::thread_count threads);

}  // namespace cli
