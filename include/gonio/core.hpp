#pragma once
/// All of `core/` except arrays.hpp, which needs xtensor, and k_d_tree.hpp, which needs nanoflann: directions, half and
/// difference angles, colours, errors, parallel loops.

#include <gonio/core/arc_tangent.hpp>
#include <gonio/core/assertion.hpp>
#include <gonio/core/brdf.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/compiled_alignment.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/directional_light.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/finite.hpp>
#include <gonio/core/fresnel.hpp>
#include <gonio/core/half.hpp>
#include <gonio/core/huge_pages.hpp>
#include <gonio/core/interpolated_colour.hpp>
#include <gonio/core/lens_distortion.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/core/pinhole_camera.hpp>
#include <gonio/core/printable.hpp>
#include <gonio/core/probability.hpp>
#include <gonio/core/progress.hpp>
#include <gonio/core/random.hpp>
#include <gonio/core/rgb.hpp>
#include <gonio/core/rotation.hpp>
#include <gonio/core/sampled_direction.hpp>
#include <gonio/core/spectrum.hpp>
#include <gonio/core/spelling.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/core/turned_pair.hpp>
#include <gonio/core/uninitialised.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/core/wavelengths.hpp>
