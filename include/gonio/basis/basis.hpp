#pragma once
/// The concept of a basis: functions over the cells of a grid, already mapped by an error metric.

#include <gonio/metric/error_metric.hpp>

#include <Eigen/Core>

#include <concepts>
#include <cstddef>
#include <span>
#include <type_traits>

namespace gonio {

/// `size()` functions over `cells()`; a BRDF is modelled at a cell, in the metric's domain, as
/// offset(cell) + row(cell) . weights.
///
/// What the compiler cannot check, and a model must keep: `row(cell)` is contiguous, has `size()` values
/// and stays valid as long as the basis or a copy of it lives; copies are cheap (they share storage);
/// all members are const and thread safe.
///
/// The smallest model: one function, the constant 1, over a grid, in linear reflectance.
/// ```cpp
/// struct constant_basis {
///   gonio::valid_cells over;
///   std::size_t size() const { return 1; }
///   const gonio::valid_cells& cells() const { return over; }
///   std::span<const float> row(std::size_t) const { static constexpr float one = 1; return {&one, 1}; }
///   double offset(std::size_t) const { return 0; }
///   identity_metric metric() const { return {}; }
/// };
/// static_assert(gonio::basis<constant_basis>);
/// ```
template <class Basis>
concept basis = requires(const Basis& functions, std::size_t cell) {
  { functions.size() } -> std::convertible_to<std::size_t>;
  { functions.cells() } -> std::convertible_to<const valid_cells&>;
  { functions.row(cell) } -> std::convertible_to<std::span<const float>>;
  { functions.offset(cell) } -> std::convertible_to<double>;
  requires error_metric<std::remove_cvref_t<decltype(functions.metric())>>;
};

/// The values of all functions at a location, interpolated in the metric's domain: size() numbers.
template <basis Basis>
[[nodiscard]] Eigen::RowVectorXd row_at(const Basis& functions, const location& at) {
  const auto row = [&](std::size_t cell) {
    const std::span<const float> values = functions.row(cell);
    return Eigen::Map<const Eigen::RowVectorXf>(values.data(), static_cast<Eigen::Index>(values.size()))
        .template cast<double>();
  };
  const Eigen::RowVectorXd zero = Eigen::RowVectorXd::Zero(static_cast<Eigen::Index>(functions.size()));
  return interpolate(at, row, zero);
}

/// The offset at a location, interpolated in the metric's domain.
template <basis Basis>
[[nodiscard]] double offset_at(const Basis& functions, const location& at) {
  return interpolate(
      at, [&](std::size_t cell) { return functions.offset(cell); }, 0.0);
}

}  // namespace gonio
