#pragma once
/// The error measures of an estimated table against its truth. None of them suffices alone: the mapped error is not
/// perceptual, and a mean colour difference does not notice a lost highlight.
/// Nielsen, Jensen and Ramamoorthi, "On Optimal, Minimal BRDF Sampling for Reflectance Acquisition", SIGGRAPH Asia
/// 2015 (doi:10.1145/2816795.2818085), Eq. 1-2 (mapping, cosine weight).

#include <gonio/evaluate/appearance_metric.hpp>
#include <gonio/metric/error_metric.hpp>
#include <gonio/metric/log_relative.hpp>

#include <Eigen/Core>

#include <limits>

namespace gonio {

/// How an estimate differs from the truth. Of the values with a channel each, `.mean()` is the mean over channels.
struct comparison {
  /// Root mean square over the truth's cells of the difference in a metric's mapped domain.
  rgb mapped_rms = rgb::Zero();
  /// The same of the difference of reflectance times max(cos_i cos_o, 0.001) (Eq. 2), in sr^-1.
  rgb cosine_rms = rgb::Zero();
  /// Mean CIELAB difference of spheres under the two lights and under the environment; see appearance_metric.
  double delta_e_lights = 0.0;
  double delta_e_env = 0.0;
  /// Peak of the estimate over that of the truth; see highlight_peak. If the truth's is zero: 1 if the estimate's
  /// is, too, otherwise infinite.
  rgb peak_ratio = rgb::Ones();
};

/// The height of a table's highlight, for each channel: the 99.9th percentile (interpolated between order
/// statistics) over the cells with theta_h below 5 degrees, or over those of the grid's smallest theta_h if it has
/// none below. Negative percentiles count as zero. Of cells whose theta_d is larger than `largest_theta_d` none is
/// looked at: without a limit the grazing rim decides, which is brighter than any highlight (of red paint the 0.1 %
/// that the percentile leaves out end at 86 degrees).
[[nodiscard]] rgb highlight_peak(const brdf_table& table, double largest_theta_d = radians(70.0));

namespace detail {

/// Finds the places of a table's cells on the cells of a metric; a metric without cells does not depend on the place.
template <error_metric Metric>
class metric_places {
 public:
  metric_places(const valid_cells& cells, const Metric& metric)
      : cells_(cells), metric_cells_(cells_of(metric, cells)), same_(cells_ == metric_cells_) {}

  [[nodiscard]] location operator()(Eigen::Index cell) const noexcept {
    return same_ ? locate_cell(cells_, cell) : locate(metric_cells_, cells_.angles(cell));
  }

 private:
  [[nodiscard]] static valid_cells cells_of(const Metric& metric, const valid_cells& cells) {
    if constexpr (requires { valid_cells(metric.cells()); }) return metric.cells();
    return cells;
  }

  valid_cells cells_;
  valid_cells metric_cells_;
  bool same_;
};

/// Sums of squares over cells, the mapped differences first.
using squared_differences = Eigen::Array<double, 6, 1>;

template <error_metric Metric>
[[nodiscard]] squared_differences sum_of_squares(const brdf_table& estimate, const brdf_table& truth,
                                                 const Metric& metric, thread_count threads) {
  constexpr double smallest_cosine_weight = 0.001;
  const metric_places<Metric> places(truth.cells(), metric);
  return sum_over_blocks(
      truth.cells().size(), 4096, squared_differences(squared_differences::Zero()),
      [&](squared_differences& sum, block range) {
        for (Eigen::Index cell = range.begin; cell < range.end; ++cell) {
          const location at = places(cell);
          const rgb e = estimate.at(cell), t = truth.at(cell);
          for (Eigen::Index channel = 0; channel < 3; ++channel) {
            const double difference = metric.forward(e[channel], at) - metric.forward(t[channel], at);
            sum[channel] += difference * difference;
          }
          const double weight = std::max(at.cosine.i * at.cosine.o, smallest_cosine_weight);
          sum.tail<3>() += ((e - t) * weight).square();
        }
      },
      threads);
}

}  // namespace detail

/// Judges an estimate by all measures, over the truth's cells; an estimate over another grid is interpolated there.
/// The mapped and cosine-weighted errors see values as they are, `metric` deciding what a negative one means.
/// `appearance` must be over the truth's cells, otherwise gonio::error is thrown. Same bytes for any number of threads.
template <error_metric Metric>
[[nodiscard]] comparison compare(const brdf_table& estimate, const brdf_table& truth, const Metric& metric,
                                 const appearance_metric& appearance, thread_count threads = {}) {
  if (!(estimate.cells() == truth.cells()))
    return compare(resample(estimate, truth.cells(), threads), truth, metric, appearance, threads);

  comparison result;
  const auto cells = static_cast<double>(truth.cells().size());
  const detail::squared_differences squares = detail::sum_of_squares(estimate, truth, metric, threads);
  result.mapped_rms = (squares.head<3>() / cells).sqrt();
  result.cosine_rms = (squares.tail<3>() / cells).sqrt();

  const appearance_difference seen = appearance.difference(estimate, truth, threads);
  result.delta_e_lights = seen.lights;
  result.delta_e_env = seen.environment;

  const rgb peak = highlight_peak(estimate), true_peak = highlight_peak(truth);
  for (Eigen::Index channel = 0; channel < 3; ++channel) {
    if (true_peak[channel] > 0.0)
      result.peak_ratio[channel] = peak[channel] / true_peak[channel];
    else
      result.peak_ratio[channel] = peak[channel] > 0.0 ? std::numeric_limits<double>::infinity() : 1.0;
  }
  return result;
}

#if defined(GONIO_COMPILED)
extern template comparison compare(const brdf_table& estimate, const brdf_table& truth, const log_relative& metric,
                                   const appearance_metric& appearance, thread_count threads);
#endif

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/evaluate/impl/comparison.ipp>
#endif
