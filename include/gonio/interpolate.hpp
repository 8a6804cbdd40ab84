#pragma once
/// Includes all of `interpolate/` except scattered_brdf.hpp, which needs nanoflann. Contains pull-push, which
/// reconstructs BRDFs without a basis, and the options of scattered interpolation.

#include <gonio/interpolate/completed_table.hpp>
#include <gonio/interpolate/pull_push.hpp>
#include <gonio/interpolate/scattered_options.hpp>
