#pragma once
/// An error metric chosen at run time, for command lines. If the metric is known, use its type instead.

#include <gonio/core/vector_kernels.hpp>
#include <gonio/metric/lin.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/metric/log_relative.hpp>
#include <gonio/metric/root.hpp>

#include <Eigen/Core>

#include <array>
#include <concepts>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>

namespace gonio {

/// Holds one of this folder's metrics and behaves like it. A basis of materials then has one type for any choice of the
/// user.
///
/// ```cpp
/// const gonio::any_metric chosen = highlights ? gonio::any_metric(gonio::lin()) : gonio::any_metric(gonio::log());
/// const auto paint = gonio::decomposition{gonio::measured{database, chosen}, gonio::nnls{}}.fit(samples);
/// ```
class any_metric {
 public:
  using choice = std::variant<log, lin, root, log_relative>;

  template <class Metric>
  requires(std::constructible_from<choice, Metric> && !std::same_as<Metric, any_metric>) any_metric(Metric held)
      : held_(std::move(held)) {}  // NOLINT: implicit

  [[nodiscard]] double forward(double rho, const auto& at) const noexcept {
    return std::visit([&](const auto& metric) -> double { return metric.forward(rho, at); }, held_);
  }
  [[nodiscard]] double inverse(double y, const auto& at) const noexcept {
    return std::visit([&](const auto& metric) -> double { return metric.inverse(y, at); }, held_);
  }

  /// Returns the held metric, for operations on many values at once.
  [[nodiscard]] const choice& held() const noexcept { return held_; }

  /// Returns the same metric over other cells.
  [[nodiscard]] any_metric on(const valid_cells& cells) const {
    return std::visit([&](const auto& metric) { return any_metric(metric.on(cells)); }, held_);
  }

  /// The number of fields that `log_relative` adds (see `row_metric`). They are zero for all other metrics.
  static constexpr int companions = log_relative::companions;
  /// Arithmetic for every metric: the held one is unknown when the fields are interpolated.
  static constexpr weighted_mean mean = weighted_mean::arithmetic;
  [[nodiscard]] std::array<float, companions> companion(Eigen::Index cell) const noexcept {
    const auto* relative = std::get_if<log_relative>(&held_);
    return relative ? relative->companion(cell) : std::array<float, companions>{};
  }
  template <class Values>
  void inverse_row(const cell_row& row, const Values& values, std::span<float> out) const {
    const auto invert = [&](const auto& metric) {
      if constexpr (std::remove_cvref_t<decltype(metric)>::mean == weighted_mean::geometric) {
        cell_fields<3 + companions> exponentials = values;
        exponentiate(exponentials.data(), exponentials.size());
        metric.inverse_row(row, exponentials, out);
      } else {
        metric.inverse_row(row, values.template topRows<3>(), out);
      }
    };
    std::visit(invert, held_);
  }

 private:
  choice held_;
};

static_assert(row_metric<any_metric>);

}  // namespace gonio
