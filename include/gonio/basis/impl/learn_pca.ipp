#pragma once
/// Bodies of basis/learn_pca.hpp.

#include <gonio/basis/learn_pca.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/solve/gram.hpp>
#include <gonio/solve/product.hpp>
#include <gonio/solve/symmetric_eigen.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <limits>

namespace gonio::detail {

/// Eigenvectors for the largest eigenvalues above rounding, largest first.
struct spectrum {
  Eigen::VectorXd eigenvalues;
  Eigen::MatrixXd eigenvectors;
};

[[nodiscard]] GONIO_INLINE spectrum largest_eigenpairs(const Eigen::MatrixXd& gram, Eigen::Index count) {
  const symmetric_eigen eigen = decompose_symmetric(gram, "the Gram matrix of the materials");
  const Eigen::VectorXd descending = eigen.values.reverse();
  const double floor = descending[0] * static_cast<double>(gram.rows()) * std::numeric_limits<double>::epsilon();
  const Eigen::Index kept = std::min<Eigen::Index>(count, (descending.array() > floor).count());
  spectrum result{descending.head(kept), eigen.vectors.rowwise().reverse().leftCols(kept)};
  for (auto vector : result.eigenvectors.colwise()) {
    Eigen::Index largest = 0;
    vector.cwiseAbs().maxCoeff(&largest);
    if (vector[largest] < 0.0) vector = -vector;
  }
  return result;
}

GONIO_INLINE component_set principal_components(const cell_matrix& centred, Eigen::Index count, thread_count threads,
                                                const progress& listener) {
  report(listener, "gram", 0.0);
  const Eigen::MatrixXd products = gram(centred, threads);
  report(listener, "components", 0.0);
  // Rounding of the mean may pretend that centring costs none.
  const auto most = std::min(count, products.cols() - 1);
  const auto [eigenvalues, vectors] = largest_eigenpairs(products, most);
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
