#pragma once
/// Images of a flat sample with a map's BRDF, seen along the normal, under distant lights.

#include <gonio/basis/pca.hpp>
#include <gonio/core/directional_light.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/io/materials/svbrdf_map.hpp>
#include <gonio/table/image.hpp>

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace cli {

/// A map under some lights, which are given in the camera's axes: x to the right, y up, z towards the camera. Reads the
/// map band by band; map and prior must outlive it.
class flat_sample {
 public:
  /// Throws gonio::error if the map was made with another prior.
  flat_sample(const gonio::io::svbrdf_map& map, const gonio::log_relative_pca& prior,
              std::span<const gonio::directional_light> lights);
  flat_sample(const flat_sample&) = delete;
  flat_sample& operator=(const flat_sample&) = delete;
  ~flat_sample();

  [[nodiscard]] const gonio::io::svbrdf_header& header() const noexcept { return map_.header(); }

  /// Returns radiance times pi, one pixel per texel. Throws gonio::error if the map is damaged.
  [[nodiscard]] gonio::image radiance(gonio::thread_count threads) const;
  /// Returns radiance times pi for a range of rows, three numbers per texel.
  [[nodiscard]] std::vector<float> radiance(gonio::block rows, gonio::thread_count threads) const;

 private:
  class lit_from_afar;
  /// Draws a range of texels of a band.
  void draw(const gonio::io::svbrdf_band& band, gonio::block texels, float* out, gonio::thread_count threads) const;

  const gonio::io::svbrdf_map& map_;
  std::vector<lit_from_afar> lit_;
};

/// Returns the exposed image of a map. Exposure 1 makes a white Lambertian surface that faces a light of irradiance 1
/// white; the default is `render::exposure_of` of the image. Throws gonio::error as `flat_sample` does.
[[nodiscard]] gonio::image flat_sample_image(const std::filesystem::path& map, const std::filesystem::path& prior,
                                             std::span<const gonio::directional_light> lights,
                                             std::optional<double> exposure, gonio::thread_count threads);

}  // namespace cli
