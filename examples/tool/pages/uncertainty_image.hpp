#pragma once
/// The uncertainty of a reconstruction as an image.

#include <gonio/core/parallel.hpp>
#include <gonio/render/image.hpp>
#include <gonio/table/brdf_table.hpp>

namespace cli {

/// Draws a sphere under the two lights of `sphere_image`, coloured by the uncertainty of each pixel's luminance: the
/// relative uncertainties of its reflectances, weighted by their contributions. The colours go from light (2 % and
/// better) to dark blue (100 % and worse) in steps of equal factors (`render::uncertainty_colour`), on black.
[[nodiscard]] gonio::image uncertainty_image(const gonio::brdf_table& table, const gonio::brdf_table& uncertainty,
                                             int size, gonio::thread_count threads);

}  // namespace cli
