#pragma once
/// BRDFs without negative values, as renderers need them: colours outside the gamut, noise and a dark signal that was
/// subtracted make measured values negative, and a renderer would subtract them from other light.

#include <gonio/core/brdf.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/model/physical_properties.hpp>
#include <gonio/table/valid_cells.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <utility>

namespace gonio::model {

/// A BRDF whose negative values are zero.
template <brdf Brdf>
class clipped_brdf {
 public:
  explicit clipped_brdf(Brdf f) : f_(std::move(f)) {}

  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept {
    return rgb(f_(wi, wo)).max(0.0);
  }

 private:
  Brdf f_;
};

/// What `clipped_brdf` changes.
struct clipped_values {
  Eigen::Index cells = 0;  ///< with a negative value in any channel
  /// What each channel reflects more of light from all sides, relative to what the channels reflect on average.
  rgb added{rgb::Zero()};
};

/// Counts the negative values of a BRDF at cells and integrates them. O(cells), and 61,200 evaluations of f if there
/// is one.
template <brdf Brdf>
[[nodiscard]] clipped_values count_negative_values(const Brdf& f, const valid_cells& cells) {
  clipped_values found;
  for (Eigen::Index cell = 0; cell < std::ssize(cells); ++cell) {
    const direction_pair pair = to_directions(cells.angles(cell));
    if ((rgb(f(pair.wi, pair.wo)) < 0.0).any()) ++found.cells;
  }
  if (found.cells == 0) return found;
  rgb reflected = rgb::Zero(), clipped = rgb::Zero();
  for (int degree = 2; degree < 90; degree += 5) {
    const double theta = radians(degree + 0.5), weight = std::sin(2.0 * theta);
    detail::for_each_light(theta, 60, [&](const direction& wi, const direction& wo, double share) {
      const rgb value = rgb(f(wi, wo)) * (weight * share);
      reflected += value;
      clipped += value.max(0.0);
    });
  }
  found.added = (clipped - reflected) / std::max(clipped.mean(), 1e-12);
  return found;
}

}  // namespace gonio::model
