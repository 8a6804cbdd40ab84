#pragma once
/// How well a reconstruction is known, as an image.

#include <gonio/core/parallel.hpp>
#include <gonio/render/image.hpp>
#include <gonio/table/brdf_table.hpp>

namespace cli {

/// A sphere under the two lights of `sphere_image`, coloured by how well the luminance of each pixel is known: the
/// relative uncertainties of the reflectances that it is made of, weighted by what they contribute. From light (2 % and
/// better) to dark blue (100 % and worse), in steps of equal factors (`render::uncertainty_colour`); black around it.
[[nodiscard]] gonio::image uncertainty_image(const gonio::brdf_table& table, const gonio::brdf_table& uncertainty,
                                             int size, gonio::thread_count threads);

}  // namespace cli
