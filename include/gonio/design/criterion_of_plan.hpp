#pragma once
/// Any criterion as a function of a set of candidates, for the searches of `search.hpp`.

#include <gonio/design/capture_geometry.hpp>
#include <gonio/design/compressed_rows.hpp>
#include <gonio/design/design_criterion.hpp>

#include <Eigen/Core>

#include <span>
#include <utility>
#include <vector>

namespace gonio::design {

/// A criterion as a `plan_objective`. Computes the rows of all samples again at each call. For the expected error,
/// `cell_candidates` and `image_candidates` are much faster.
///
/// ```cpp
/// const gonio::design::point_geometry points(prior.cells());
/// const gonio::design::criterion_of_plan condition{prior, points, gonio::design::condition_number{}};
/// const auto five = gonio::design::grow_and_descend(points, condition, 5);
/// ```
template <basis Basis, capture_geometry Geometry, design_criterion Criterion>
class criterion_of_plan {
 public:
  criterion_of_plan(Basis basis, Geometry geometry, Criterion criterion)
      : basis_(std::move(basis)), geometry_(std::move(geometry)), criterion_(std::move(criterion)) {}

  [[nodiscard]] const Geometry& geometry() const noexcept { return geometry_; }

  [[nodiscard]] double operator()(std::span<const Eigen::Index> candidates) const {
    std::vector<half_difference> directions;
    for (const Eigen::Index candidate : candidates) {
      const std::vector<half_difference> more = geometry_.directions(candidate);
      directions.insert(directions.end(), more.begin(), more.end());
    }
    return criterion_(rows_at(basis_, directions).components);
  }

 private:
  Basis basis_;
  Geometry geometry_;
  Criterion criterion_;
};

}  // namespace gonio::design
