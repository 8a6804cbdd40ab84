#pragma once
/// Measurements located on the cells of a basis.

#include <gonio/core/parallel.hpp>
#include <gonio/metric/error_metric.hpp>
#include <gonio/table/brdf_table.hpp>
#include <gonio/table/sample_set.hpp>

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace gonio {

/// One value for each colour channel of each sample: 3 x n.
using channel_values = Eigen::Array<float, 3, Eigen::Dynamic>;

/// The locations, values and weights of n measurements.
struct located_samples {
  std::vector<location> locations;
  Eigen::MatrixXd values;  ///< n x channels: reflectance in sr^-1, or any other values observed at the locations
  /// The weights, n x channels; n x 1 if each measurement has one weight for all channels.
  Eigen::MatrixXd weights;
  gonio::channels kinds = {};  ///< the channels that the columns of `values` stand for, if these are reflectances

  [[nodiscard]] Eigen::Index size() const noexcept { return locations.size(); }

  /// Returns true if each channel has its own weights.
  [[nodiscard]] bool weighs_channels_apart() const noexcept { return weights.cols() > 1; }
  [[nodiscard]] Eigen::VectorXd weights_of(Eigen::Index channel) const {
    return weights.col(weighs_channels_apart() ? channel : 0);
  }

  /// Returns the weights in three channels: 3 x n.
  [[nodiscard]] channel_values channel_weights() const;

  /// Returns the values of three channels: 3 x n.
  [[nodiscard]] channel_values channels() const;

  /// Returns the samples in three channels, for computing but not for display: see `channels::three`.
  [[nodiscard]] located_samples in_three_channels() const;

  /// Returns the samples at their invisible wavelengths; none if no wavelength is visible, or all are.
  [[nodiscard]] std::optional<located_samples> at_invisible_wavelengths() const;

  /// Returns the samples at the given positions.
  [[nodiscard]] located_samples subset(const std::vector<Eigen::Index>& positions) const;
};

namespace detail {

/// Computes the samples' locations on the cells from their angles.
void locate_angles(located_samples& samples, const valid_cells& cells, thread_count threads);

}  // namespace detail

/// Returns the samples in three channels, for estimators of colours. Repeats a single channel. Throws gonio::error for
/// any other number of channels.
[[nodiscard]] located_samples in_colours(located_samples samples);

/// Locates samples on given cells, in their own channels. Leaves out samples whose weight is zero in all channels, so
/// that they do not affect outlier weights. Throws gonio::error for unusable samples (`require_usable`), for a
/// reflectance outside the range of float, or if all weights are zero. O(samples).
[[nodiscard]] located_samples locate_samples(const valid_cells& cells, const sample_set& samples,
                                             thread_count threads = {});

/// Makes every cell of a table a measurement of weight 1. Throws gonio::error naming the first cell that is not finite.
[[nodiscard]] located_samples locate_samples(const valid_cells& cells, const brdf_table& table,
                                             thread_count threads = {});

/// Maps reflectances at given locations by a metric: 3 x n.
template <error_metric Metric>
[[nodiscard]] channel_values map_values(const Metric& metric, const channel_values& values,
                                        const std::vector<location>& locations, thread_count threads = {}) {
  channel_values mapped(3, values.cols());
  for_each_index(
      locations.size(), 1024,
      [&](Eigen::Index i) {
        for (Eigen::Index c = 0; c < 3; ++c) {
          mapped(c, i) = static_cast<float>(metric.forward(double{values(c, i)}, locations[i]));
        }
      },
      threads);
  return mapped;
}

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/located_samples.ipp>
#endif
