#pragma once
/// What README's first program needs: samples and a prior in, a complete BRDF out. `gonio/<module>.hpp` has all of a
/// module; a header costs what it names.

#include <gonio/estimate/reconstruction.hpp>
#include <gonio/io/materials/merl.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/measurements/samples.hpp>
