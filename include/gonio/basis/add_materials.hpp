#pragma once
/// Adds materials to a learned prior, without the tables that it was learned from. Ross, Lim, Lin and Yang,
/// "Incremental Learning for Robust Visual Tracking", IJCV 2008 (doi:10.1007/s11263-007-0075-7), section 2.1.

#include <gonio/basis/learn_streamed_pca.hpp>

namespace gonio {

/// Returns the prior of a prior's materials and new ones, over the prior's cells. Only the components of the old
/// materials are known; the rest of them is lost. The reference stays the prior's, not the median of all. Singular
/// values stay in the prior's scale, which may be that of more cells than it kept. `options.weighting` is not used: the
/// prior's stays.
///
/// O(cells (k + m)^2) for m new columns and k old components, or as learn_streamed_pca above `exact_columns`. Throws
/// gonio::error as learn_streamed_pca does, and if the materials are over other cells, at other wavelengths, or have a
/// name that the prior has.
///
/// ```cpp
/// const auto learned = gonio::add_materials(gonio::io::read_prior("old.prior"), gonio::rows_of(materials));
/// gonio::io::write_prior("new.prior", learned.prior);
/// ```
[[nodiscard]] streamed_pca add_materials(const log_relative_pca& prior, material_rows materials,
                                         const streaming_options& options = {}, const progress& listener = {});

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/basis/impl/add_materials.ipp>
#endif
