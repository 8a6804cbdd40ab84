#pragma once
/// All of `table/`: grids, valid cells, tables, samples.

#include <gonio/table/aperture.hpp>
#include <gonio/table/brdf_table.hpp>
#include <gonio/table/cell_matrix.hpp>
#include <gonio/table/channels.hpp>
#include <gonio/table/domain.hpp>
#include <gonio/table/grid.hpp>
#include <gonio/table/image.hpp>
#include <gonio/table/location.hpp>
#include <gonio/table/material_rows.hpp>
#include <gonio/table/material_set.hpp>
#include <gonio/table/sample_set.hpp>
#include <gonio/table/spectral_table.hpp>
#include <gonio/table/stored_codes.hpp>
#include <gonio/table/surface_image.hpp>
#include <gonio/table/table_convention.hpp>
#include <gonio/table/tensor_view.hpp>
#include <gonio/table/upsample.hpp>
#include <gonio/table/valid_cells.hpp>
#include <gonio/table/viewer_side.hpp>
