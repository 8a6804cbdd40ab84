#pragma once
/// Principal components as images: slices as in Nielsen et al. 2015, Fig. 3 and 4, and Nielsen's thesis, Fig. 4.6, and
/// spheres that show the effect of a component.

#include <gonio/basis/basis.hpp>
#include <gonio/basis/component_variance.hpp>
#include <gonio/basis/pca.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/render/image.hpp>
#include <gonio/render/slice.hpp>

#include <Eigen/Core>

#include <string>
#include <vector>

namespace cli {

/// A figure of components side by side.
struct component_figure {
  gonio::image image;
  std::vector<double> limits;  ///< value of pure red in each slice, in the metric's domain
};

namespace detail {

/// Colours slices. `values` has a row per pixel, row by row from the top, and a column for the BRDF and each component.
[[nodiscard]] component_figure colour_slices(const Eigen::MatrixXd& values, int size,
                                             const Eigen::VectorXd& shares_of_variance, const std::string& name);

}  // namespace detail

/// Draws slices at phi_d = 90 degrees, theta_h to the right as sqrt(theta_h), theta_d upwards. The first is the BRDF to
/// which the metric is relative, or else the mean, times pi. The others show one standard deviation of each of the
/// first components in the metric's domain: white is zero, red positive, blue negative, each scaled by its largest
/// absolute value in the slice. Below them stand `name`, the shares of variance and the axes.
template <gonio::error_metric Metric>
[[nodiscard]] component_figure draw_component_slices(const gonio::pca<Metric>& prior, Eigen::Index count, int size,
                                                     gonio::thread_count threads, const std::string& name = {}) {
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
  return detail::colour_slices(values, size, gonio::variance_shares(prior), name);
}

/// Draws spheres under the two lights: a column for each of the first components, with weights of -2, -1, 0, 1 and 2
/// standard deviations from top to bottom, all other weights zero. All have the exposure for which the sphere of the
/// mean is white at its 99th percentile.
[[nodiscard]] gonio::image draw_component_spheres(const gonio::log_relative_pca& prior, Eigen::Index count, int size,
                                                  gonio::thread_count threads);

}  // namespace cli
