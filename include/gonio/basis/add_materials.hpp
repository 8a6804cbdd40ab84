#pragma once
/// Adds materials to a learned prior, without the tables that it was learned from. Ross, Lim, Lin and Yang,
/// "Incremental Learning for Robust Visual Tracking", IJCV 2008 (doi:10.1007/s11263-007-0075-7), section 2.1.

#include <gonio/basis/learn_streamed_pca.hpp>

namespace gonio {

/// Returns a prior of the given prior's materials and the new ones, over the given prior's cells. Of the old materials,
/// only the part that the components explain is known. The reference stays the given prior's, not the median of all
/// materials. Singular values stay in the given prior's scale, although that prior may have been learned over more
/// cells than it keeps. The given prior's cosine weighting stays, too: `options.weighting` is not used.
///
/// O(cells (k + m)^2) for m new columns and k old components, or like learn_streamed_pca if these exceed
/// `exact_columns`. Throws gonio::error as learn_streamed_pca does, and if the materials are over other cells, at other
/// wavelengths, or have a name that the prior has.
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
