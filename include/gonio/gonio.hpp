#pragma once
/// The headers of README's first program, which reconstructs a complete BRDF from samples and a prior.
/// `gonio/<module>.hpp` includes all of a module; a single header includes only what it needs.

#include <gonio/estimate/reconstruction.hpp>
#include <gonio/io/materials/merl.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/measurements/samples.hpp>
