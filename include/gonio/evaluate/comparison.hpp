#pragma once
/// Error measures of an estimated table against its truth. No measure suffices alone: the mapped error is not
/// perceptual, and a mean colour difference hardly changes if a highlight is lost. Nielsen, Jensen and Ramamoorthi, "On
/// Optimal, Minimal BRDF Sampling for Reflectance Acquisition", SIGGRAPH Asia 2015 (doi:10.1145/2816795.2818085), Eq.
/// 1-2 (mapped error, cosine-weighted error).

#include <gonio/evaluate/appearance_metric.hpp>
#include <gonio/metric/error_metric.hpp>
#include <gonio/metric/log_relative.hpp>

#include <Eigen/Core>

#include <limits>

namespace gonio {

/// The difference between an estimate and the truth. An `rgb` has a value for each channel; its `.mean()` is the mean
/// over the channels.
struct comparison {
  /// Root mean square of the difference in a metric's mapped domain, over the truth's cells.
  rgb mapped_rms = rgb::Zero();
  /// Root mean square of the difference of reflectance times max(cos_i cos_o, 0.001) (Eq. 2), in sr^-1.
  rgb cosine_rms = rgb::Zero();
  /// Mean CIELAB difference of spheres under the two lights and under the environment; see appearance_metric.
  double delta_e_lights = 0.0;
  double delta_e_env = 0.0;
  /// Ratio of the highlight peaks (`highlight_peak`), estimate to truth. If the truth's peak is zero, the ratio is 1 if
  /// the estimate's is also zero, otherwise infinite.
  rgb peak_ratio = rgb::Ones();
};

/// Returns the height of a table's highlight for each channel: the 99.9th percentile (interpolated between order
/// statistics) over the cells with theta_h below 5 degrees or, if there is none, with the grid's smallest theta_h.
/// Negative percentiles count as zero. Ignores cells with theta_d above `largest_theta_d`: grazing cells are brighter
/// than any highlight and would determine the result.
[[nodiscard]] rgb highlight_peak(const brdf_table& table, double largest_theta_d = radians(70.0));

namespace detail {

/// Locates a table's cells on the cells of a metric. A metric without cells does not depend on the location.
template <error_metric Metric>
class metric_locations {
 public:
  metric_locations(const valid_cells& cells, const Metric& metric)
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

/// Sums of squared differences over cells: three of mapped values (one for each channel), then three of cosine-weighted
/// values.
using squared_differences = Eigen::Array<double, 6, 1>;

template <error_metric Metric>
[[nodiscard]] squared_differences sum_of_squares(const brdf_table& estimate, const brdf_table& truth,
                                                 const Metric& metric, thread_count threads) {
  constexpr double smallest_cosine_weight = 0.001;
  const metric_locations<Metric> locations(truth.cells(), metric);
  return sum_over_blocks(
      truth.cells().size(), 4096, squared_differences(squared_differences::Zero()),
      [&](squared_differences& sum, block range) {
        for (Eigen::Index cell = range.begin; cell < range.end; ++cell) {
          const location at = locations(cell);
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

/// Evaluates all error measures of an estimate over the truth's cells. An estimate over another grid is interpolated.
/// The mapped and cosine-weighted errors use unclamped values; `metric` determines the effect of a negative value.
/// Throws gonio::error unless `appearance` is over the truth's cells. The bytes do not depend on the number of threads.
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
