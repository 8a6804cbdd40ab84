#include "flat_sample.hpp"

#include "tool/options/shipped_data.hpp"
#include <gonio/core/half.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/io/materials/svbrdf_map.hpp>
#include <gonio/render/exposure.hpp>
#include <gonio/table/location.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <numbers>
#include <utility>
#include <vector>

namespace cli {

/// A distant light. All texels have the same directions: a texel's mapped value is the product of its weights with one
/// row of the functions, plus an offset.
class flat_sample::lit_from_afar {
 public:
  lit_from_afar(const gonio::log_relative_pca& prior, const Eigen::MatrixXf& functions,
                const gonio::directional_light& light)
      : prior_(prior),
        at_(gonio::locate(prior.cells(), gonio::to_half_difference(light.towards, gonio::direction(0.0, 0.0, 1.0)))),
        row_((gonio::row_at(prior, at_) * functions.cast<double>()).transpose()),
        offset_(gonio::offset_at(prior, at_)),
        irradiance_(light.irradiance * light.towards.z()) {}

  /// Returns radiance times pi for the map's weights of a texel.
  [[nodiscard]] gonio::rgb operator()(const std::uint16_t* weights) const {
    gonio::rgb value;
    for (Eigen::Index c = 0; c < 3; ++c) {
      double mapped = offset_;
      for (Eigen::Index i = 0; i < row_.size(); ++i) mapped += row_[i] * double{gonio::from_half(*weights++)};
      value[c] = gonio::reflectance_of(prior_.metric(), mapped, at_);
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

flat_sample::flat_sample(const gonio::io::svbrdf_map& map, const gonio::log_relative_pca& prior,
                         std::span<const gonio::directional_light> lights)
    : map_(map) {
  map.require_prior(prior);
  for (const gonio::directional_light& light : lights)
    if (light.towards.z() > 0.0) lit_.emplace_back(prior, map.header().functions, light);
}

flat_sample::~flat_sample() = default;

void flat_sample::draw(const gonio::io::svbrdf_band& band, gonio::block texels, float* out,
                       gonio::thread_count threads) const {
  gonio::for_each_index(
      texels.size(), 4096,
      [&](Eigen::Index i) {
        const Eigen::Index texel = texels.begin + i;
        if (!band.has_material(texel)) return;
        gonio::rgb sum = gonio::rgb::Zero();
        for (const lit_from_afar& light : lit_)
          sum += light(band.weights.data() + 3 * texel * header().functions.cols());
        for (Eigen::Index c = 0; c < 3; ++c) out[3 * i + c] = static_cast<float>(sum[c]);
      },
      threads);
}

gonio::image flat_sample::radiance(gonio::thread_count threads) const {
  gonio::image picture =
      gonio::uniform_image(static_cast<std::size_t>(header().rows), static_cast<std::size_t>(header().columns));
  float* next = picture.data();
  for (Eigen::Index number = 0; number < header().bands(); ++number) {
    const Eigen::Index texels = header().texels_of_band(number);
    draw(map_.read_band(number), {0, texels}, next, threads);
    next += 3 * texels;
  }
  return picture;
}

std::vector<float> flat_sample::radiance(gonio::block rows, gonio::thread_count threads) const {
  const Eigen::Index columns = header().columns, band_rows = header().band_rows;
  std::vector<float> found(static_cast<std::size_t>(3 * rows.size() * columns));
  float* next = found.data();
  while (rows.begin < rows.end) {
    const Eigen::Index number = rows.begin / band_rows, first = number * band_rows;
    const gonio::block own{rows.begin - first, std::min(rows.end - first, band_rows)};
    draw(map_.read_band(number), {own.begin * columns, own.end * columns}, next, threads);
    next += 3 * own.size() * columns;
    rows.begin += own.size();
  }
  return found;
}

gonio::image flat_sample_image(const std::filesystem::path& map, const std::filesystem::path& prior,
                               std::span<const gonio::directional_light> lights, std::optional<double> exposure,
                               gonio::thread_count threads) {
  const gonio::io::svbrdf_map opened(map);
  const gonio::log_relative_pca own = read_prior(prior);
  gonio::image picture = flat_sample(opened, own, lights).radiance(threads);
  gonio::render::expose(picture, exposure ? *exposure : gonio::render::exposure_of(picture));
  return picture;
}

}  // namespace cli
