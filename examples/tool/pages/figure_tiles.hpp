#pragma once
/// The tiles of figures like those of Noell, Koehler and Stricker 2014: slices at phi_d = 90 degrees, spheres, and
/// images of their differences.

#include <gonio/evaluate/sphere_delta_e.hpp>
#include <gonio/render/image.hpp>
#include <gonio/render/slice.hpp>
#include <gonio/table/sample_set.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace cli {

/// Cells along each side of a slice, and points across a sphere; a tile has twice as many pixels.
inline constexpr int cells_across_tile = 72;
inline constexpr int tile_size = 2 * cells_across_tile;

template <gonio::brdf Brdf>
[[nodiscard]] gonio::image slice_tile(const Brdf& f, gonio::thread_count threads) {
  return gonio::render::render_slice(f, {.rows = tile_size, .columns = tile_size}, threads);
}

/// Returns a factor's colour, from the mean of the channels' logarithms: blue for a half or less, white for 1, red for
/// 2 or more.
[[nodiscard]] gonio::rgb factor_colour(const gonio::rgb& sigma);

/// Draws a slice of factors in false colour. `sigma(wi, wo)` is a factor for each channel.
template <class Sigma>
[[nodiscard]] gonio::image factor_tile(const Sigma& sigma, gonio::thread_count threads) {
  const auto colour = [&](const gonio::direction& wi, const gonio::direction& wo) noexcept -> gonio::rgb {
    return factor_colour(sigma(wi, wo)) / std::numbers::pi;  // the slice multiplies by pi
  };
  return slice_tile(colour, threads);
}

/// Draws the samples near a slice: those within half a degree or, if these are fewer than 400, the 400 nearest. Sample
/// i is a square of the colour `colour(i)`, 4 x 4 pixels for up to 400 samples, otherwise 2 x 2; the rest of the tile
/// has the colour `nothing`.
[[nodiscard]] gonio::image samples_tile(const gonio::sample_set& samples, const gonio::rgb& nothing,
                                        const std::function<gonio::rgb(Eigen::Index)>& colour);

/// Draws the samples near a slice in their own colours, on the figure's background.
[[nodiscard]] gonio::image measurements_tile(const gonio::sample_set& samples);

/// A tile and the label below it.
struct labelled_tile {
  gonio::image image;
  std::string label;
};

/// Return the scales of the colours in other tiles.
[[nodiscard]] labelled_tile delta_e_scale_tile();
[[nodiscard]] labelled_tile factor_scale_tile();

/// Arranges tiles in columns, which may have different lengths. The last line names the axes of slices.
[[nodiscard]] gonio::image tiles_in_columns(const std::vector<std::vector<labelled_tile>>& columns);

/// Spheres under one lighting, all with the exposure of the reference.
class sphere_tiles {
 public:
  sphere_tiles(gonio::sphere_delta_e delta_e, const gonio::brdf_table& reference, gonio::thread_count threads)
      : threads_(threads), delta_e_(std::move(delta_e)), reference_(delta_e_.expose(reference, threads)) {}

  [[nodiscard]] gonio::image sphere(const gonio::brdf_table& table) const;

  struct verdict {
    gonio::image image;
    double mean = 0.0;
  };
  /// Returns the CIELAB difference between the spheres of a table and of the reference.
  [[nodiscard]] verdict difference(const gonio::brdf_table& table) const;

 private:
  gonio::thread_count threads_;
  gonio::sphere_delta_e delta_e_;
  gonio::sphere_appearance reference_;
};

}  // namespace cli
