#pragma once
/// The pictures that the tool makes of tables.

#include <gonio/io/image.hpp>
#include <gonio/render/slice.hpp>
#include <gonio/render/sphere.hpp>

namespace cli {

/// A sphere under the two lights of Nielsen et al. 2015, Figure 2.
[[nodiscard]] inline gonio::image sphere_picture(const gonio::brdf_table& table, gonio::thread_count threads) {
  return gonio::render_sphere(table, gonio::two_lights(), {.size = 256, .supersampling = 3}, threads);
}

/// A slice at phi_d = 90 degrees: theta_h to the right, theta_d upwards.
[[nodiscard]] inline gonio::image slice_picture(const gonio::brdf_table& table, gonio::thread_count threads) {
  return gonio::render_slice(table, {.rows = 256, .columns = 256}, threads);
}

}  // namespace cli
