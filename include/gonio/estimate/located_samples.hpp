#pragma once
/// Measurements placed on the cells of a basis.

#include <gonio/core/parallel.hpp>
#include <gonio/metric/error_metric.hpp>
#include <gonio/table/brdf_table.hpp>
#include <gonio/table/sample_set.hpp>

#include <Eigen/Core>

#include <vector>

namespace gonio {

/// One value for each colour channel of each sample: 3 x n.
using channel_values = Eigen::Array<float, 3, Eigen::Dynamic>;

/// Where was measured, what, and how much it counts, which is more than nothing: n of each.
struct located_samples {
  std::vector<location> locations;
  Eigen::MatrixXd values;  ///< n x channels: red, green and blue in sr^-1, or whatever is observed over the domain
  /// n x channels, or n x 1 if each measurement counts the same in all channels.
  Eigen::MatrixXd weights;
  gonio::channels kinds = {};  ///< what the columns of `values` are, where they are reflectances

  [[nodiscard]] Eigen::Index size() const noexcept { return locations.size(); }

  /// Is there a measurement that counts more in one channel than in another?
  [[nodiscard]] bool weighs_channels_apart() const noexcept { return weights.cols() > 1; }
  /// What the measurements count in one channel.
  [[nodiscard]] Eigen::VectorXd weights_of(Eigen::Index channel) const {
    return weights.col(weighs_channels_apart() ? channel : 0);
  }

  /// The weights of three channels as estimators keep them.
  [[nodiscard]] channel_values channel_weights() const;

  /// The values of three channels as estimators keep them.
  [[nodiscard]] channel_values channels() const;

  /// The same samples for whoever looks at three channels and shows none: see `channels::three`.
  [[nodiscard]] located_samples in_three_channels() const;

  /// The half and difference angles of all samples.
  [[nodiscard]] std::vector<half_difference> angles() const;

  /// Some of the samples, by their positions.
  [[nodiscard]] located_samples subset(const std::vector<Eigen::Index>& positions) const;
};

namespace detail {

/// Completes the locations.
void locate_angles(located_samples& samples, const valid_cells& cells, thread_count threads);

}  // namespace detail

/// The same samples, a single channel being repeated in all three, for estimators of colours. Throws gonio::error for
/// another number.
[[nodiscard]] located_samples in_colours(located_samples samples);

/// Samples on given cells, in the channels that they have. Those of weight zero in all channels are left out: whatever
/// looks at all samples, as outlier weights do, must not see them. Throws gonio::error for unusable ones
/// (`require_usable`), for a reflectance beyond the range of float, or if all weights are zero. O(samples).
[[nodiscard]] located_samples locate_samples(const valid_cells& cells, const sample_set& samples,
                                             thread_count threads = {});

/// Every cell of a table as a measurement of weight 1. Throws gonio::error naming the first cell that is not finite.
[[nodiscard]] located_samples locate_samples(const valid_cells& cells, const brdf_table& table,
                                             thread_count threads = {});

/// Reflectances at given locations under a metric: 3 x n.
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
