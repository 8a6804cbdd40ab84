#pragma once
/// All of `interpolate/` except scattered_brdf.hpp, which needs nanoflann: BRDFs without a basis, by pull-push or
/// between nearest neighbours.

#include <gonio/interpolate/completed_table.hpp>
#include <gonio/interpolate/pull_push.hpp>
#include <gonio/interpolate/scattered_options.hpp>
