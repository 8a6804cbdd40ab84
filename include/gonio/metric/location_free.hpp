#pragma once
/// Common base of error metrics that are the same at every location.

#include <gonio/metric/error_metric.hpp>
#include <gonio/table/upsample.hpp>

#include <span>

namespace gonio {

/// Base of a metric with `static double map(double rho)`, `static double unmap(double y)` (or non-static members), and
/// `unmap_all(values)` on a span of floats. Makes it an `error_metric` that also maps whole rows back.
template <class Metric>
class location_free_metric {
 public:
  [[nodiscard]] double forward(double rho, const auto& /*at*/) const noexcept { return metric().map(rho); }
  [[nodiscard]] double inverse(double y, const auto& /*at*/) const noexcept { return metric().unmap(y); }

  /// Returns the same metric over other cells.
  [[nodiscard]] const Metric& on(const valid_cells& /*cells*/) const noexcept { return metric(); }

  /// The metric adds no fields of its own to the three channels that are interpolated.
  static constexpr int companions = 0;
  static constexpr weighted_mean mean = weighted_mean::arithmetic;

  /// See `row_metric`.
  template <class Values>
  void inverse_row(const cell_row& row, const Values& values, std::span<float> out) const {
    Eigen::Map<Eigen::Array<float, 3, Eigen::Dynamic>> unmapped(out.data(), 3, row.count);
    unmapped = values;
    metric().unmap_all(out);
    unmapped = unmapped.max(0.0f);
  }

 private:
  [[nodiscard]] const Metric& metric() const noexcept { return static_cast<const Metric&>(*this); }
};

}  // namespace gonio
