#include "figure_tiles.hpp"

#include "colour_scale.hpp"
#include "image_text.hpp"
#include <gonio/render/false_colour.hpp>

#include <numeric>

namespace cli {

namespace {

constexpr std::size_t margin = 6;
constexpr std::size_t label_rows = 14;
const gonio::rgb background = gonio::rgb::Constant(0.35);

/// Returns the image with each pixel as a square of 2 x 2.
gonio::image doubled(const gonio::image& image) {
  gonio::image large({2 * image.shape(0), 2 * image.shape(1), std::size_t{3}});
  for (std::size_t row = 0; row < large.shape(0); ++row)
    for (std::size_t column = 0; column < large.shape(1); ++column)
      gonio::set_pixel(large, row, column, gonio::pixel(image, row / 2, column / 2));
  return large;
}

/// Returns a scale as wide as a tile.
labelled_tile scale_tile(const colour_scale& scale, const char* label) {
  labelled_tile tile{gonio::uniform_image(rows_of_scale(tile_size), tile_size), label};
  draw_scale(tile.image, scale);
  return tile;
}

/// Returns the distance of a sample from the slice at phi_d = 90 degrees, in radians.
double distance_to_slice(const gonio::sample& s) {
  const double turns = s.angles().phi_d / std::numbers::pi;
  return std::abs(turns - std::floor(turns) - 0.5) * std::numbers::pi;
}

/// Returns the samples that a slice shows, the nearest last.
std::vector<Eigen::Index> samples_near_slice(const gonio::sample_set& samples) {
  constexpr std::size_t enough = 400;
  std::vector<Eigen::Index> order(samples.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return std::pair(distance_to_slice(samples[i]), i); });
  std::size_t count = std::min(enough, order.size());
  while (count < order.size() && distance_to_slice(samples[order[count]]) <= gonio::radians(0.51)) ++count;
  order.resize(count);
  std::ranges::reverse(order);
  return order;
}

}  // namespace

gonio::rgb factor_colour(const gonio::rgb& sigma) {
  return gonio::render::diverging_colour(sigma.max(1e-6).log().mean() / std::numbers::ln2, 1.0);
}

gonio::image samples_tile(const gonio::sample_set& samples, const gonio::rgb& nothing,
                          const std::function<gonio::rgb(Eigen::Index)>& colour) {
  const gonio::grid nodes({cells_across_tile, cells_across_tile, 1}, gonio::cell_anchor::centre);
  const auto shown = samples_near_slice(samples);
  const int reach = shown.size() <= 400 ? 1 : 0;
  gonio::image image = gonio::uniform_image(tile_size, tile_size, nothing);
  for (const Eigen::Index i : shown) {
    const gonio::half_difference in_slice{samples[i].angles().theta_h, samples[i].angles().theta_d, 0.0};
    const gonio::cell_index cell = nodes.nearest(in_slice);
    const int left = 2 * cell.theta_h, top = tile_size - 2 - 2 * cell.theta_d;
    for (int row = std::max(top - reach, 0); row < std::min(top + 2 + reach, tile_size); ++row)
      for (int column = std::max(left - reach, 0); column < std::min(left + 2 + reach, tile_size); ++column)
        gonio::set_pixel(image, row, column, colour(i));
  }
  return image;
}

gonio::image measurements_tile(const gonio::sample_set& samples) {
  return samples_tile(samples, background,
                      [&](Eigen::Index i) { return gonio::rgb(std::numbers::pi * samples[i].value); });
}

labelled_tile delta_e_scale_tile() { return scale_tile(delta_e_scale(), "Delta E"); }

labelled_tile factor_scale_tile() { return scale_tile(factor_scale(), "factor"); }

gonio::image tiles_in_columns(const std::vector<std::vector<labelled_tile>>& columns) {
  std::vector<std::size_t> tops{margin};  // the top of each row of tiles and of the last line
  for (std::size_t y = 0;; ++y) {
    std::size_t highest = 0;
    for (const auto& column : columns)
      if (y < column.size()) highest = std::max(highest, column[y].image.shape(0));
    if (highest == 0) break;
    tops.push_back(tops.back() + highest + label_rows + margin);
  }
  constexpr std::size_t step = std::size_t{tile_size} + margin;
  gonio::image canvas = gonio::uniform_image(tops.back() + label_rows, margin + columns.size() * step, background);
  for (std::size_t x = 0; x < columns.size(); ++x)
    for (std::size_t y = 0; y < columns[x].size(); ++y) {
      const auto& [image, label] = columns[x][y];
      gonio::render::paste(canvas, image, tops[y], margin + x * step);
      const std::size_t width = std::min(extent_of(label, 1).columns, std::size_t{tile_size});
      draw_text(canvas, tops[y] + image.shape(0) + 4, margin + x * step + (tile_size - width) / 2, label, 1,
                gonio::rgb::Zero());
    }
  draw_text(canvas, tops.back(), margin, "Slices: theta_h to the right, theta_d upwards, phi_d 90 degrees", 1,
            gonio::rgb::Zero());
  return canvas;
}

gonio::image sphere_tiles::sphere(const gonio::brdf_table& table) const {
  const gonio::render::sphere_colours colours = reference_.exposure * delta_e_.sphere().apply(table, threads_);
  return doubled(delta_e_.sphere().to_image(colours, background));
}

sphere_tiles::verdict sphere_tiles::difference(const gonio::brdf_table& table) const {
  const auto seen = delta_e_.look(table, reference_.exposure, threads_);
  return {doubled(delta_e_.difference_image(seen, reference_, 20.0, background)),
          delta_e_.difference(seen, reference_)};
}

}  // namespace cli
