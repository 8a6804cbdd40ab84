#include "cli/flat_sample.hpp"

#include <gonio/core/half.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/io/prior.hpp>
#include <gonio/io/svbrdf_map.hpp>
#include <gonio/render/exposure.hpp>
#include <gonio/table/location.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <numbers>
#include <utility>
#include <vector>

namespace cli {

namespace {

/// All texels are lit and seen in the same directions: of each, a product with the functions there.
class lit_from_afar {
 public:
  lit_from_afar(const gonio::log_relative_pca& prior, const Eigen::MatrixXf& functions,
                const gonio::directional_light& light)
      : prior_(prior),
        at_(gonio::locate(prior.cells(), gonio::to_half_difference(light.towards, gonio::direction(0.0, 0.0, 1.0)))),
        row_((gonio::row_at(prior, at_) * functions.cast<double>()).transpose()),
        offset_(gonio::offset_at(prior, at_)),
        irradiance_(light.irradiance * light.towards.z()) {}

  /// Radiance times pi, of weights as the map has them.
  [[nodiscard]] gonio::rgb operator()(const std::uint16_t* weights) const {
    gonio::rgb value;
    for (Eigen::Index c = 0; c < 3; ++c) {
      double mapped = offset_;
      for (Eigen::Index i = 0; i < row_.size(); ++i) mapped += row_[i] * double{gonio::from_half(*weights++)};
      value[c] = std::max(prior_.metric().inverse(mapped, at_), 0.0);
    }
    return std::numbers::pi * value * irradiance_;
  }

 private:
  const gonio::log_relative_pca& prior_;
  gonio::location at_;
  Eigen::VectorXd row_;
  double offset_;
  gonio::rgb irradiance_;
};

}  // namespace

gonio::image flat_sample_radiance(const gonio::io::svbrdf_map& map, const gonio::log_relative_pca& prior,
                                  std::span<const gonio::directional_light> lights, gonio::thread_count threads) {
  map.require_prior(prior);
  const gonio::io::svbrdf_header& header = map.header();
  std::vector<lit_from_afar> lit;
  for (const gonio::directional_light& light : lights)
    if (light.towards.z() > 0.0) lit.emplace_back(prior, header.functions, light);
  gonio::image picture =
      gonio::uniform_image(static_cast<std::size_t>(header.rows), static_cast<std::size_t>(header.columns));
  for (Eigen::Index number = 0; number < header.bands(); ++number) {
    const gonio::io::svbrdf_band band = map.read_band(number);
    float* const first = picture.data() + 3 * number * header.band_rows * header.columns;
    gonio::for_each_index(
        header.texels_of_band(number), 4096,
        [&](Eigen::Index texel) {
          if (!band.has_material(texel)) return;
          gonio::rgb sum = gonio::rgb::Zero();
          for (const lit_from_afar& light : lit)
            sum += light(band.weights.data() + 3 * texel * header.functions.cols());
          for (Eigen::Index c = 0; c < 3; ++c) first[3 * texel + c] = static_cast<float>(sum[c]);
        },
        threads);
  }
  return picture;
}

gonio::image flat_sample_image(const std::filesystem::path& map, const std::filesystem::path& prior,
                               std::span<const gonio::directional_light> lights, std::optional<double> exposure,
                               gonio::thread_count threads) {
  gonio::image picture =
      flat_sample_radiance(gonio::io::svbrdf_map(map), gonio::io::read_prior(prior), lights, threads);
  gonio::render::expose(picture, exposure ? *exposure : gonio::render::exposure_of(picture));
  return picture;
}

}  // namespace cli
