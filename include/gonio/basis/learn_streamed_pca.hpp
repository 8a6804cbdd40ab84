#pragma once
/// Principal components of materials that do not fit into memory: the same as learn_pca finds, from at most three
/// passes over blocks of cells. Nielsen et al. 2015 (doi:10.1145/2816795.2818085), Eq. 4-6; more columns than a Gram
/// matrix can have by random vectors, Halko et al. 2011 (doi:10.1137/090771806).

#include <gonio/basis/mapped_materials.hpp>
#include <gonio/basis/pca.hpp>
#include <gonio/core/progress.hpp>
#include <gonio/solve/leading_eigenpairs.hpp>
#include <gonio/solve/row_groups.hpp>
#include <gonio/table/material_rows.hpp>

#include <Eigen/Core>

#include <cstdint>

namespace gonio {

struct streaming_options {
  Eigen::Index components = 60;
  cosine_weighting weighting = cosine_weighting::product;
  /// Up to as many columns, 3 a material or one for each wavelength, have their Gram matrix decomposed; more are found
  /// in a random subspace. From 600 to 900 columns on that takes less time (docs/results/learn.md).
  Eigen::Index exact_columns = 1024;
  subspace_options subspace = {};
  /// What the learner may hold, in bytes, beside the prior that it returns. With more threads than have room in it, it
  /// uses fewer.
  std::uint64_t memory = std::uint64_t{2} << 30;
  thread_count threads = {};
  shared_groups share = {};  ///< with other processes: the one that writes gets the prior, others parts of it
};

/// A prior, and how it was found.
struct streamed_pca {
  log_relative_pca prior;
  bool exact = true;  ///< else in a random subspace
  /// As many squared singular values of all the columns lie within this distance of the prior's, as a share of the
  /// observations' variance. 0 if exact.
  double residual = 0.0;
};

namespace detail {

/// Completes what a first pass has found.
void complete_rows(const shared_groups& share, const mapped_materials& mapped);

/// A = V Sigma U', cut after the components that are kept.
struct streamed_components {
  leading_eigenpairs pairs;  ///< Sigma^2 and U
  cell_matrix scaled;        ///< V Sigma
  bool exact;
};

/// Of rows, the columns of which have one dependency: `first` is read in the first pass, `again` in the others. Throws
/// gonio::error if there is no component.
[[nodiscard]] streamed_components components_of(const row_source& first, const row_source& again,
                                                const streaming_options& options, const progress& listener);

}  // namespace detail

/// Principal components of the materials under log_relative to their median. Two passes over the cells, or as many as
/// `subspace.products`, 3 by default. O(cells m^2) for m columns, or O(cells m components). The same bytes for any
/// number of threads. Throws gonio::error as learn_pca does, and what reading throws.
///
/// ```cpp
/// const auto learned = gonio::learn_streamed_pca(gonio::rows_of(materials), {.components = 60});
/// gonio::io::write_prior("my.prior", learned.prior);
/// ```
[[nodiscard]] streamed_pca learn_streamed_pca(material_rows materials, const streaming_options& options = {},
                                              const progress& listener = {});

/// The same relative to a reference that is known, with its weighting instead of that of the options. Throws
/// gonio::error as well unless the reference is over the materials' cells.
[[nodiscard]] streamed_pca learn_streamed_pca(material_rows materials, const log_relative& reference,
                                              const streaming_options& options = {}, const progress& listener = {});

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/basis/impl/learn_streamed_pca.ipp>
#endif
