#pragma once
/// Learns principal components of materials that do not fit into memory, in two passes over blocks of cells. The result
/// is that of learn_pca. Nielsen et al. 2015 (doi:10.1145/2816795.2818085), Eq. 4-6. If there are too many columns for
/// a Gram matrix, uses random vectors (Halko et al. 2011, doi:10.1137/090771806), by default in three passes, with
/// errors of about 1e-11 of the variance (docs/results/learn.md).

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
  /// Up to this many columns (3 a material, or one for each of its wavelengths), the Gram matrix is decomposed exactly.
  /// With more columns, the components are found in a random subspace, which is faster from about 600 columns on
  /// (docs/results/learn.md).
  Eigen::Index exact_columns = 1024;
  subspace_options subspace = {};
  /// The memory that learning may use, in bytes, in addition to the returned prior. If the threads would need more,
  /// fewer threads are used.
  std::uint64_t memory = std::uint64_t{2} << 30;
  thread_count threads = {};
  shared_groups share =
      {};  ///< work with other processes: the process that writes gets the whole prior, all others get parts
};

/// A prior, and the accuracy of its computation.
struct streamed_pca {
  log_relative_pca prior;
  bool exact = true;  ///< false: found in a random subspace
  /// Each squared singular value is within this distance of an exact one, as a share of the observations' variance. 0
  /// if exact.
  double residual = 0.0;
};

namespace detail {

/// Sends the results of the first pass from all processes to the one that writes the prior.
void complete_rows(const shared_groups& share, const mapped_materials& mapped);

/// The factors of the matrix of rows, A = V Sigma U', truncated to the kept components.
struct streamed_components {
  leading_eigenpairs pairs;  ///< Sigma^2 and U
  cell_matrix scaled;        ///< V Sigma
  bool exact;
};

/// Returns the components of rows whose columns have one linear dependency. `first` is read in the first pass over the
/// cells, `again` in all later passes. Throws gonio::error if there is no component.
[[nodiscard]] streamed_components components_of(const row_source& first, const row_source& again,
                                                const streaming_options& options, const progress& listener);

}  // namespace detail

/// Returns the principal components of the materials under log_relative to their median. Makes two passes over the
/// cells, or `subspace.products` passes (3 by default) for a random subspace. O(cells m^2) for m columns, or O(cells m
/// components). Any number of threads gives the same bytes. Throws gonio::error as learn_pca does, and anything that
/// reading throws.
///
/// ```cpp
/// const auto learned = gonio::learn_streamed_pca(gonio::rows_of(materials), {.components = 60});
/// gonio::io::write_prior("my.prior", learned.prior);
/// ```
[[nodiscard]] streamed_pca learn_streamed_pca(material_rows materials, const streaming_options& options = {},
                                              const progress& listener = {});

/// Returns the components relative to a known reference, with the reference's weighting instead of `options.weighting`.
/// Also throws gonio::error unless the reference is over the materials' cells.
[[nodiscard]] streamed_pca learn_streamed_pca(material_rows materials, const log_relative& reference,
                                              const streaming_options& options = {}, const progress& listener = {});

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/basis/impl/learn_streamed_pca.ipp>
#endif
