#pragma once
/// Bodies of shape/shape_model.hpp.

#include <gonio/basis/learn_pca.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/metric/lin.hpp>
#include <gonio/shape/alignment.hpp>
#include <gonio/shape/shape_basis.hpp>
#include <gonio/shape/shape_model.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace gonio::shape {

GONIO_INLINE shape_model shape_model::truncated_to_variance(double share) const {
  shape_model fewer(*this);
  fewer.basis_ = gonio::shape::truncated_to_variance(basis_, share);
  return fewer;
}

GONIO_INLINE shape_model learn_shape_model(const std::vector<point_columns>& shapes, std::vector<std::string> names,
                                           triangle_columns triangles, thread_count threads) {
  (void)shape_set::of(shapes, names);  // refuses inconsistent shapes, and names them
  if (std::ranges::all_of(shapes, [&](const point_columns& shape) { return shape == shapes.front(); }))
    refuse({"a shape model needs at least two different shapes, not ", shapes.size(), " equal ones"});
  const aligned_shapes aligned = procrustes_mean(shapes);
  const Eigen::Index components = shapes.size();
  return {learn_pca(shape_set::of(aligned.shapes, std::move(names)), lin{}, components, threads), std::move(triangles)};
}

}  // namespace gonio::shape
