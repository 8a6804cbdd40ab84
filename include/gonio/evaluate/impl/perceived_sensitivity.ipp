#pragma once
/// Bodies of evaluate/perceived_sensitivity.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/rgb.hpp>
#include <gonio/evaluate/perceived_sensitivity.hpp>
#include <gonio/render/lighting.hpp>
#include <gonio/render/sphere.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <utility>

namespace gonio::detail {

/// Returns by how much CIELAB changes, as a distance, for each unit of one channel of a displayed colour.
[[nodiscard]] GONIO_INLINE double colour_slope(const rgb& colour, Eigen::Index channel) {
  const double step = 0.02 * std::max(colour[channel], 0.02);
  rgb below = colour, above = colour;
  below[channel] -= step;
  above[channel] += step;
  const rgb change = to_lab(above.max(0.0).min(1.0)) - to_lab(below.max(0.0).min(1.0));
  return change.matrix().norm() / (2.0 * step);
}

}  // namespace gonio::detail

namespace gonio {

GONIO_INLINE perceived_sensitivity::perceived_sensitivity(valid_cells cells, int size, thread_count threads)
    : cells_(std::move(cells)) {
  // 60 x 48 half-vector bins of the environment suffice for a highlight of coarse cells.
  const std::array<render::sphere_operator, 2> spheres{
      render::sphere_operator(cells_, render::environment_lighting(60, 48), size, threads),
      render::sphere_operator(cells_, render::two_lights(), size, threads)};
  const Eigen::Index points = std::ssize(spheres[0].points());
  weights_ = Eigen::VectorXd::Constant(2 * points, 0.5 / static_cast<double>(points));
  for (Eigen::MatrixXd& channel : light_) channel = Eigen::MatrixXd::Zero(2 * points, cells_.size());
  for (Eigen::Index sphere = 0; sphere < 2; ++sphere)
    for (Eigen::Index point = 0; point < points; ++point)
      spheres[sphere].for_each_entry(point, [&](Eigen::Index cell, const rgb& weight) {
        for (Eigen::Index c = 0; c < 3; ++c) light_[c](sphere * points + point, cell) += weight[c];
      });
}

GONIO_INLINE design::sensitivity perceived_sensitivity::operator()(const Eigen::MatrixXd& reflectance,
                                                                   const Eigen::MatrixXd& derivative) const {
  const Eigen::Index points = weights_.size(), cells = cells_.size();
  if (reflectance.rows() != cells || derivative.rows() != cells || reflectance.cols() != 3 || derivative.cols() != 3)
    refuse({"a sensitivity over ", cells, " cells needs a row of three channels for each, not ", reflectance.rows(),
            " x ", reflectance.cols()});
  Eigen::MatrixXd colours(points, 3);
  for (Eigen::Index c = 0; c < 3; ++c) colours.col(c).noalias() = light_[c] * reflectance.col(c);
  design::sensitivity seen{Eigen::MatrixXd(3 * points, cells), weights_};
  for (Eigen::Index point = 0; point < points; ++point)
    for (Eigen::Index c = 0; c < 3; ++c) {
      const double slope = detail::colour_slope(colours.row(point).transpose().array(), c);
      seen.slopes.row(3 * point + c) = slope * light_[c].row(point).cwiseProduct(derivative.col(c).transpose());
    }
  return seen;
}

}  // namespace gonio
