#include "uncertainty_image.hpp"

#include <gonio/render/false_colour.hpp>
#include <gonio/render/horizon_lookup.hpp>
#include <gonio/render/sphere.hpp>

namespace cli {

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
      const gonio::rgb colour =
          luminance > 0.0
              ? gonio::render::uncertainty_colour(gonio::luminance(gonio::pixel(deviation, row, column)) / luminance)
              : gonio::rgb(gonio::rgb::Zero());
      gonio::set_pixel(coloured, row, column, colour);
    }
  return coloured;
}

}  // namespace cli
