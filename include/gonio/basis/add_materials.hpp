#pragma once
/// Materials that come after a prior was learned, without the tables that it was learned from. Ross, Lim, Lin and Yang,
/// "Incremental Learning for Robust Visual Tracking", IJCV 2008 (doi:10.1007/s11263-007-0075-7), section 2.1.

#include <gonio/basis/learn_streamed_pca.hpp>

namespace gonio {

/// The prior of the materials that a prior was learned from and of others, over the prior's cells. What the prior keeps
/// of the former is its components; what it did not keep is lost. The reference stays the prior's: it is not moved to
/// the median of all. Singular values stay in the prior's scale, which may be that of more cells than it kept.
/// `options.weighting` is not used: the prior's stays.
///
/// O(cells (k + m)^2) for m new columns and k old components, or as learn_streamed_pca above `exact_columns`. Throws
/// gonio::error as that does, and if the materials are over other cells, at other wavelengths, or one has a name that
/// the prior has.
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
