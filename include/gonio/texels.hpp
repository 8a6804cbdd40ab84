#pragma once
/// All of `texels/`: a BRDF for each texel of a flat sample.

#include <gonio/texels/texel_brdf.hpp>
#include <gonio/texels/texel_decomposition.hpp>
#include <gonio/texels/texel_metric.hpp>
