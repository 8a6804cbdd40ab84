#pragma once
/// An error metric chosen at run time, for command lines. Programs that know theirs name it instead.

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

/// Holds one of this folder's metrics, and gives what that one gives. What a basis makes of materials is then one type,
/// whatever the user says.
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
      : held_(std::move(held)) {}  // NOLINT: conversion is the point

  [[nodiscard]] double forward(double rho, const auto& at) const noexcept {
    return std::visit([&](const auto& metric) -> double { return metric.forward(rho, at); }, held_);
  }
  [[nodiscard]] double inverse(double y, const auto& at) const noexcept {
    return std::visit([&](const auto& metric) -> double { return metric.inverse(y, at); }, held_);
  }

  /// For what is done to many values at once.
  [[nodiscard]] const choice& held() const noexcept { return held_; }

  /// The same metric over other cells.
  [[nodiscard]] any_metric on(const valid_cells& cells) const {
    return std::visit([&](const auto& metric) { return any_metric(metric.on(cells)); }, held_);
  }

  /// As many as the metric with the most has; of the others it is zero. See `row_metric`.
  static constexpr int companions = log_relative::companions;
  /// What is held is not known when the fields are interpolated.
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
