#pragma once
/// All of `design/`: where to measure.

#include <gonio/design/apparatus.hpp>
#include <gonio/design/capture_constraint.hpp>
#include <gonio/design/capture_geometry.hpp>
#include <gonio/design/cell_candidates.hpp>
#include <gonio/design/compressed_rows.hpp>
#include <gonio/design/criterion_of_plan.hpp>
#include <gonio/design/design_criterion.hpp>
#include <gonio/design/error_sweep.hpp>
#include <gonio/design/exhaustive_search.hpp>
#include <gonio/design/expected_error.hpp>
#include <gonio/design/image_candidates.hpp>
#include <gonio/design/left_out_squares.hpp>
#include <gonio/design/near_field_geometry.hpp>
#include <gonio/design/published_directions.hpp>
#include <gonio/design/reading_variances.hpp>
#include <gonio/design/search.hpp>
#include <gonio/design/sequential_design.hpp>
#include <gonio/design/sphere_geometry.hpp>
