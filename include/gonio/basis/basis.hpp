#pragma once
/// The concept of a basis: functions over the cells of a grid, already mapped by an error metric.

#include <gonio/metric/error_metric.hpp>
#include <gonio/solve/row_source.hpp>
#include <gonio/table/domain.hpp>

#include <Eigen/Core>

#include <concepts>
#include <numeric>
#include <span>
#include <type_traits>
#include <vector>

namespace gonio {

/// Requirements of every basis: `size()` functions over `cells()`. At a location, offset + row . weights models a BRDF
/// mapped by `metric()`; the row has the values of all functions there. Other domains, such as vertex coordinates, work
/// in the same way.
template <class Basis>
concept function_set = requires(const Basis& functions, Eigen::Index cell) {
  { functions.size() } -> std::convertible_to<Eigen::Index>;
  requires domain<std::remove_cvref_t<decltype(functions.cells())>>;
  { functions.offset(cell) } -> std::convertible_to<double>;
  requires error_metric<std::remove_cvref_t<decltype(functions.metric())>>;
};

/// A basis that stores its rows: `row(cell)` is the row at a cell. Between cells, rows are interpolated.
///
/// Requirements that the compiler cannot check: `row(cell)` is contiguous, has `size()` values and stays valid as long
/// as the basis or a copy of it lives; copies are cheap (they share storage); all members are const and thread safe.
///
/// With a model of the library:
/// ```cpp
/// #include <gonio/io/materials/prior.hpp>
///
/// #include <cstdio>
///
/// int main() {
///   const gonio::log_relative_pca prior = gonio::io::read_prior("materials.prior");
///   const std::span<const float> row = prior.row(0);
///   std::printf("%zu functions; the first is %g at cell 0\n", row.size(), double{row[0]});
/// }
/// ```
/// With a model of your own, the constant 1 over a grid:
/// ```cpp
/// #include <gonio/estimate/decomposition.hpp>
/// #include <gonio/metric/lin.hpp>
/// #include <gonio/solve/tikhonov.hpp>
///
/// #include <cstdio>
///
/// struct constant_basis {
///   gonio::valid_cells over;
///   Eigen::Index size() const { return 1; }
///   const gonio::valid_cells& cells() const { return over; }
///   std::span<const float> row(Eigen::Index) const { static constexpr float one = 1; return {&one, 1}; }
///   double offset(Eigen::Index) const { return 0; }
///   gonio::lin metric() const { return {}; }
/// };
/// static_assert(gonio::tabulated_basis<constant_basis>);
///
/// int main() {
///   gonio::sample_set samples;
///   samples.push_back({gonio::half_difference{0.1, 0.2, 0.3}, gonio::rgb::Constant(0.25), 1.0});
///   const auto fit = gonio::decomposition{constant_basis{gonio::valid_cells()}, gonio::tikhonov{1e-9}}.fit(samples);
///   std::printf("the constant is %g\n", fit.weights()(0, 0));
/// }
/// ```
template <class Basis>
concept tabulated_basis = function_set<Basis> && requires(const Basis& functions, Eigen::Index cell) {
  { functions.row(cell) } -> std::convertible_to<std::span<const float>>;
};

/// The row into which a computed basis writes the values of its functions.
using function_row = Eigen::Ref<Eigen::RowVectorXd>;

/// A basis that computes its rows, in double precision, at any location: `read_row(at, out)` writes the row at the
/// exact angles of a location. For functions given by a formula, whose rows at a million cells would not fit into
/// memory.
///
/// Requirements that the compiler cannot check: all `size()` numbers of `out` are written; `read_row` neither allocates
/// nor throws; copies are cheap; all members are const and thread safe.
///
/// With a model of the library:
/// ```cpp
/// #include <gonio/basis/rbf.hpp>
/// #include <gonio/metric/log.hpp>
///
/// #include <cstdio>
///
/// int main() {
///   const gonio::rbf functions{gonio::valid_cells(), gonio::log{}};
///   const gonio::location here = gonio::locate(functions.cells(), {0.1, 0.2, 0.3});
///   std::printf("the first of %td is %g\n", functions.size(), gonio::row_at(functions, here)[0]);
/// }
/// ```
/// With a model of your own, a polynomial in theta_d:
/// ```cpp
/// #include <gonio/basis/basis.hpp>
/// #include <gonio/metric/lin.hpp>
///
/// #include <cstdio>
///
/// struct theta_d_polynomial {
///   gonio::valid_cells over;
///   Eigen::Index size() const { return 2; }
///   const gonio::valid_cells& cells() const { return over; }
///   void read_row(const gonio::location& at, gonio::function_row out) const { out << 1, at.angles.theta_d; }
///   double offset(Eigen::Index) const { return 0; }
///   gonio::lin metric() const { return {}; }
/// };
/// static_assert(gonio::computed_basis<theta_d_polynomial>);
///
/// int main() {
///   const theta_d_polynomial functions{gonio::valid_cells()};
///   std::printf("%g\n", gonio::row_at(functions, gonio::locate(functions.cells(), {0.1, 0.2, 0.3}))[1]);
/// }
/// ```
template <class Basis>
concept computed_basis = function_set<Basis> && !tabulated_basis<Basis> &&
                         requires(const Basis& functions, const location& at, function_row out) {
  functions.read_row(at, out);
};

/// Functions whose combinations model a BRDF, with rows stored or computed.
template <class Basis>
concept basis = tabulated_basis<Basis> || computed_basis<Basis>;

/// Three bases over the same cells with the same number of functions and the same metric, one for each colour channel.
template <class Basis>
concept channelwise_basis = requires(const Basis& functions, Eigen::Index channel) {
  { functions.size() } -> std::convertible_to<Eigen::Index>;
  { functions.cells() } -> std::convertible_to<const valid_cells&>;
  { functions.channel(channel) } -> basis;
  requires error_metric<std::remove_cvref_t<decltype(functions.metric())>>;
};

/// The basis of an estimator: one basis for all channels, or one for each of three channels.
template <class Basis>
concept colour_basis = basis<Basis> || channelwise_basis<Basis>;

/// The domain of the functions of a basis.
template <colour_basis Basis>
using domain_of = std::remove_cvref_t<decltype(std::declval<const Basis&>().cells())>;

/// Returns the basis of one colour channel. If all channels share a basis, returns a reference to it, without a copy.
template <colour_basis Basis>
[[nodiscard]] decltype(auto) channel_of(const Basis& functions, Eigen::Index channel) {
  if constexpr (basis<Basis>)
    return (functions);
  else
    return functions.channel(channel);
}

/// Returns the numbers of the functions that may take part in a fit, in ascending order. If the basis has `columns()`,
/// these are the numbers it returns; otherwise, all. The remaining functions have weight zero.
template <colour_basis Basis>
[[nodiscard]] std::vector<Eigen::Index> columns_of(const Basis& functions) {
  std::vector<Eigen::Index> columns;
  if constexpr (requires { functions.columns(); }) {
    columns.assign(functions.columns().begin(), functions.columns().end());
  } else {
    columns.resize(functions.size());
    std::iota(columns.begin(), columns.end(), Eigen::Index{0});
  }
  return columns;
}

/// True if the signs of the functions are arbitrary, like those of principal components. Such a basis declares `static
/// constexpr bool arbitrary_sign = true;`.
template <class Basis>
inline constexpr bool has_arbitrary_sign = requires {
  requires bool(Basis::arbitrary_sign);
};

namespace detail {

/// Adds a weight times the values of a row to `out`, or assigns the product for the first row.
inline void blend_row(double weight, std::span<const float> values, bool first, double* out) {
  if (first)
    for (Eigen::Index i = 0; i < std::ssize(values); ++i) out[i] = weight * double{values[i]};
  else
    for (Eigen::Index i = 0; i < std::ssize(values); ++i) out[i] += weight * double{values[i]};
}

}  // namespace detail

/// Writes the values of all functions at a location to a row of size() contiguous numbers. A tabulated basis is
/// interpolated in the metric's domain; a computed one is exact.
template <basis Basis>
void read_row_at(const Basis& functions, const location& at, function_row out) {
  if constexpr (computed_basis<Basis>) {
    functions.read_row(at, out);
  } else {
    for (int corner = 0; corner < at.count; ++corner) {
      detail::blend_row(at.weight[corner], functions.row(at.cell[corner]), corner == 0, out.data());
    }
  }
}

/// Writes the values of all functions at many locations, into a row of `out` for each. Uses the basis' own `read_rows`
/// if it has one, which is faster for many rows.
template <basis Basis>
void read_rows_at(const Basis& functions, std::span<const location> at, row_block out) {
  if constexpr (requires { functions.read_rows(at, out); })
    functions.read_rows(at, out);
  else
    for (Eigen::Index i = 0; i < std::ssize(at); ++i)
      read_row_at(functions, at[i], Eigen::Map<Eigen::RowVectorXd>(&out(i, 0), out.cols()));
}

/// Returns the values of all functions at a location: size() numbers. See `read_row_at`.
template <basis Basis>
[[nodiscard]] Eigen::RowVectorXd row_at(const Basis& functions, const location& at) {
  Eigen::RowVectorXd row(functions.size());
  read_row_at(functions, at, row);
  return row;
}

/// Returns the values of all functions at many locations: locations x size().
template <basis Basis>
[[nodiscard]] Eigen::MatrixXd rows_at(const Basis& functions, std::span<const location> at) {
  row_matrix contiguous(std::ssize(at), functions.size());
  read_rows_at(functions, at, contiguous);
  Eigen::MatrixXd rows(contiguous.rows(), contiguous.cols());
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    for (Eigen::Index k = 0; k < rows.cols(); ++k) rows(i, k) = contiguous(i, k);
  return rows;
}

/// Returns the offset at a location, interpolated in the metric's domain.
template <basis Basis>
[[nodiscard]] double offset_at(const Basis& functions, const location& at) {
  return interpolate(
      at, [&](Eigen::Index cell) { return functions.offset(cell); }, 0.0);
}

}  // namespace gonio
