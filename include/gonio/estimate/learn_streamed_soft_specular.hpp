#pragma once
/// Learns the priors of soft and of specular materials from materials that do not fit into memory, in passes over
/// blocks of cells. The result is that of learn_soft_specular_prior. Nielsen et al. 2015 (doi:10.1145/2816795.2818085),
/// section 8.

#include <gonio/basis/learn_streamed_pca.hpp>
#include <gonio/basis/soft_specular_prior.hpp>
#include <gonio/core/progress.hpp>
#include <gonio/table/material_rows.hpp>

#include <optional>

namespace gonio {

/// The priors of soft and of specular materials, and the accuracy of their computation.
struct streamed_soft_specular {
  soft_specular_prior prior;
  bool exact = true;      ///< false if one of the priors was found in a random subspace
  double residual = 0.0;  ///< the larger of the two priors' residuals; see `streamed_pca`
};

/// Learns the principal components of the soft and of the specular materials, relative to the median of all materials.
/// Splits the materials by the contrast of their highlights, by default at the median contrast. Makes one pass over the
/// cells for medians and contrasts, then the passes of learn_streamed_pca for each half, which read the cells of all
/// materials. O(cells m^2) for m columns, or O(cells m components) in a random subspace. Any number of threads gives
/// the same bytes. `options.share` is not used. Throws gonio::error as learn_soft_specular_prior does, and whatever
/// `materials.read` throws.
///
/// ```cpp
/// const auto learned = gonio::learn_streamed_soft_specular(gonio::rows_of(materials), {.components = 60});
/// gonio::io::write_soft_specular_prior("split.prior", learned.prior);
/// ```
[[nodiscard]] streamed_soft_specular learn_streamed_soft_specular(const material_rows& materials,
                                                                  const streaming_options& options = {},
                                                                  std::optional<double> threshold = {},
                                                                  const progress& listener = {});

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/learn_streamed_soft_specular.ipp>
#endif
