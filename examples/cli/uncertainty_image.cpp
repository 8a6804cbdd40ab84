#include "uncertainty_image.hpp"

#include <gonio/render/horizon_lookup.hpp>
#include <gonio/render/sphere.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace cli {

namespace {

/// The colour of a relative uncertainty, in linear light.
gonio::rgb colour_of(double uncertainty) {
  static const std::array<gonio::rgb, 4> colours{gonio::rgb{0.02, 0.06, 0.5}, gonio::rgb{0.02, 0.6, 0.7},
                                                 gonio::rgb{0.9, 0.75, 0.05}, gonio::rgb{0.7, 0.02, 0.02}};
  const double position = std::clamp(1.5 * std::log10(std::max(uncertainty, 1e-9) / 0.01), 0.0, 3.0);
  const int below = std::min(static_cast<int>(position), 2);
  const double share = position - below;
  return (1.0 - share) * colours[below] + share * colours[below + 1];
}

}  // namespace

gonio::image uncertainty_image(const gonio::brdf_table& table, const gonio::brdf_table& uncertainty, int size,
                               gonio::thread_count threads) {
  const gonio::render::horizon_lookup value(table), relative(uncertainty);
  const auto unsure = [&](const gonio::direction& wi, const gonio::direction& wo) noexcept -> gonio::rgb {
    return value(wi, wo) * relative(wi, wo);
  };
  const auto seen = [&](const auto& f) {
    return gonio::render::render_sphere(f, gonio::render::two_lights(), {.size = size}, threads);
  };
  const gonio::image known = seen(value), deviation = seen(unsure);
  gonio::image coloured = known;
  for (std::size_t row = 0; row < coloured.shape(0); ++row)
    for (std::size_t column = 0; column < coloured.shape(1); ++column) {
      const double luminance = gonio::luminance(gonio::pixel(known, row, column));
      const gonio::rgb colour = luminance > 0.0
                                    ? colour_of(gonio::luminance(gonio::pixel(deviation, row, column)) / luminance)
                                    : gonio::rgb(gonio::rgb::Zero());
      gonio::set_pixel(coloured, row, column, colour);
    }
  return coloured;
}

}  // namespace cli
