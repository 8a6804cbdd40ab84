#pragma once
/// Principal components as images: slices as in Nielsen et al. 2015, Fig. 3 and 4, and Nielsen's thesis, Fig. 4.6, and
/// spheres of what a component changes.

#include <gonio/basis/basis.hpp>
#include <gonio/basis/component_variance.hpp>
#include <gonio/basis/pca.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/render/image.hpp>
#include <gonio/render/slice.hpp>

#include <Eigen/Core>

#include <vector>

namespace cli {

/// A figure of components side by side.
struct component_figure {
  gonio::image image;
  std::vector<double> limits;  ///< what pure red stands for in each slice, in the metric's domain
};

namespace detail {

/// Values at the pixels of slices, row by row from the top: a column for each component, and one in front.
[[nodiscard]] component_figure colour_slices(const Eigen::MatrixXd& values, int size);

}  // namespace detail

/// Slices at phi_d = 90 degrees, theta_h to the right as sqrt(theta_h), theta_d upwards: the BRDF that the metric is
/// relative to, or else the mean, times pi; then what one standard deviation of each of the first components adds in
/// the metric's domain, white where it is nothing, red where it is positive and blue where it is negative, each in a
/// scale of its own from minus to plus its largest value in the slice.
template <gonio::error_metric Metric>
[[nodiscard]] component_figure draw_component_slices(const gonio::pca<Metric>& prior, Eigen::Index count, int size,
                                                     gonio::thread_count threads) {
  const gonio::pca<Metric> first = prior.truncated(count);
  const Eigen::RowVectorXd deviations = gonio::weight_deviations(first.coefficients()).transpose();
  const gonio::render::slice_view view{.rows = size, .columns = size};
  Eigen::MatrixXd values(Eigen::Index{size} * size, 1 + count);
  gonio::for_each_index(
      values.rows(), size,
      [&](Eigen::Index pixel) {
        const gonio::location at =
            gonio::locate(first.cells(), gonio::render::slice_angles(view, pixel / size, pixel % size));
        if constexpr (requires { first.metric().reference(at); })
          values(pixel, 0) = first.metric().reference(at);
        else
          values(pixel, 0) = first.metric().inverse(gonio::offset_at(first, at), at);
        const Eigen::RowVectorXd row = gonio::row_at(first, at);
        for (Eigen::Index k = 0; k < count; ++k) values(pixel, 1 + k) = row[k] * deviations[k];
      },
      threads);
  return detail::colour_slices(values, size);
}

/// Spheres under the two lights: a column for each of the first components, with weights of -2, -1, 0, 1 and 2 standard
/// deviations from the top to the bottom, all other weights being zero. All are exposed alike, such that the sphere of
/// the mean is white at its 99th percentile.
[[nodiscard]] gonio::image draw_component_spheres(const gonio::log_relative_pca& prior, Eigen::Index count, int size,
                                                  gonio::thread_count threads);

}  // namespace cli
