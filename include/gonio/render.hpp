#pragma once
/// Everything that a renderer needs of a measured or reconstructed BRDF, and nothing else: look-up, importance
/// sampling, and a view that can be passed to files without this header. Needs Eigen's Core and the standard library.
/// Reads no files and estimates nothing. Compiles with -fno-exceptions -fno-rtti; errors then end the program instead
/// of throwing. After construction nothing allocates, locks or throws, and any number of threads may read.
/// ```cpp
/// const auto table = gonio::render::lookup_table<Eigen::half>::from_merl(planes);
/// const gonio::render::half_vector_sampler paint(table);
/// const auto [wi, weight, pdf] = paint.sample(wo, u1, u2);
/// ```

// Renderers that include these headers as their own may compile with -Wsign-conversion; our indices are signed
// (decision 18 of docs/decisions).
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wsign-conversion"

#include <gonio/render/bsdf_view.hpp>
#include <gonio/render/cell_finder.hpp>
#include <gonio/render/component_brdf.hpp>
#include <gonio/render/grid_coordinates.hpp>
#include <gonio/render/half_vector_sampler.hpp>
#include <gonio/render/horizon_index.hpp>
#include <gonio/render/lookup_table.hpp>
#include <gonio/render/merl_view.hpp>
#include <gonio/render/padded_grid.hpp>
#include <gonio/texels/texel_brdf.hpp>

#pragma GCC diagnostic pop
