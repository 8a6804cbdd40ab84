#pragma once
/// Learns principal components of materials that do not fit into memory, in at most three passes over blocks of cells.
/// The result is that of learn_pca. Nielsen et al. 2015 (doi:10.1145/2816795.2818085), Eq. 4-6. If there are too many
/// columns for a Gram matrix, uses random vectors: Halko et al. 2011 (doi:10.1137/090771806).

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
  /// Up to this many columns, 3 a material or one for each wavelength, their Gram matrix is decomposed. More are found
  /// in a random subspace, which is faster from 600 to 900 columns on (docs/results/learn.md).
  Eigen::Index exact_columns = 1024;
  subspace_options subspace = {};
  /// The memory of the learner in bytes, without the prior that it returns. It uses fewer threads if they would need
  /// more.
  std::uint64_t memory = std::uint64_t{2} << 30;
  thread_count threads = {};
  shared_groups share =
      {};  ///< with other processes: the process that writes gets the whole prior, the others get parts
};

/// A prior, and the accuracy of its computation.
struct streamed_pca {
  log_relative_pca prior;
  bool exact = true;  ///< false: found in a random subspace
  /// As many squared singular values of all columns are within this distance of the prior's, as a share of the
  /// observations' variance. 0 if exact.
  double residual = 0.0;
};

namespace detail {

/// Completes the results of a first pass.
void complete_rows(const shared_groups& share, const mapped_materials& mapped);

/// A = V Sigma U', truncated to the kept components.
struct streamed_components {
  leading_eigenpairs pairs;  ///< Sigma^2 and U
  cell_matrix scaled;        ///< V Sigma
  bool exact;
};

/// Returns the components of rows whose columns have one linear dependency. `first` is read in the first pass, `again`
/// in the others. Throws gonio::error if there is no component.
[[nodiscard]] streamed_components components_of(const row_source& first, const row_source& again,
                                                const streaming_options& options, const progress& listener);

}  // namespace detail

/// Returns the principal components of the materials under log_relative to their median. Makes two passes over the
/// cells, or `subspace.products` passes (3 by default) for a random subspace. O(cells m^2) for m columns, or O(cells m
/// components). The same bytes for any number of threads. Throws gonio::error as learn_pca does, and anything that
/// reading throws.
///
/// ```cpp
/// const auto learned = gonio::learn_streamed_pca(gonio::rows_of(materials), {.components = 60});
/// gonio::io::write_prior("my.prior", learned.prior);
/// ```
[[nodiscard]] streamed_pca learn_streamed_pca(material_rows materials, const streaming_options& options = {},
                                              const progress& listener = {});

/// Returns the components relative to a known reference, with its weighting instead of that of the options. Also throws
/// gonio::error unless the reference is over the materials' cells.
[[nodiscard]] streamed_pca learn_streamed_pca(material_rows materials, const log_relative& reference,
                                              const streaming_options& options = {}, const progress& listener = {});

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/basis/impl/learn_streamed_pca.ipp>
#endif
