#pragma once
/// Bodies of basis/learn_pca.hpp.

#include <gonio/basis/learn_pca.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/solve/gram.hpp>
#include <gonio/solve/leading_eigenpairs.hpp>
#include <gonio/solve/product.hpp>

#include <Eigen/Core>

#include <algorithm>

namespace gonio::detail {

GONIO_INLINE component_set principal_components(const cell_matrix& centred, Eigen::Index count, thread_count threads,
                                                const progress& listener) {
  report(listener, "gram", 0.0);
  const Eigen::MatrixXd products = gram(centred, threads);
  report(listener, "components", 0.0);
  // Centred observations have one component fewer than columns. Rounding of the mean may seem to add the missing one.
  const auto most = std::min(count, products.cols() - 1);
  const auto [eigenvalues, vectors, residual] = decompose_leading(products, most, "the Gram matrix of the materials");
  if (eigenvalues.size() == 0) refuse("the materials do not differ: there is nothing to learn");

  component_set found{eigenvalues.cwiseSqrt(), cell_matrix(centred.rows(), vectors.cols()), vectors.cast<float>(),
                      eigenvalues.sum() / products.trace()};
  for_each_block(
      centred.rows(), 2048,
      [&](block range) {
        const Eigen::Index begin = range.begin, rows = range.size();
        found.scaled.middleRows(begin, rows) =
            product(centred.middleRows(begin, rows).cast<double>(), vectors).cast<float>();
      },
      threads);
  report(listener, "components", 1.0);
  return found;
}

}  // namespace gonio::detail
