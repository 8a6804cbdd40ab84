// The bodies of table/.

#include <gonio/table/impl/aperture.ipp>
#include <gonio/table/impl/brdf_table.ipp>
#include <gonio/table/impl/channels.ipp>
#include <gonio/table/impl/image.ipp>
#include <gonio/table/impl/material_rows.ipp>
#include <gonio/table/impl/material_set.ipp>
#include <gonio/table/impl/sample_set.ipp>
#include <gonio/table/impl/spectral_table.ipp>
#include <gonio/table/impl/tensor_view.ipp>
#include <gonio/table/impl/upsample.ipp>
#include <gonio/table/impl/valid_cells.ipp>
#include <gonio/table/impl/viewer_side.ipp>
