#pragma once
/// Checks the members of a decomposition's metric, basis and solver one by one, for readable compiler messages.

#include <gonio/basis/basis.hpp>
#include <gonio/solve/solver.hpp>

#include <Eigen/Core>

#include <type_traits>
#include <utility>

namespace gonio::detail {

template <class Basis>
struct metric_of {
  using type = void;
};
template <class Basis>
requires requires(const Basis& functions) { functions.metric(); }
struct metric_of<Basis> {
  using type = std::remove_cvref_t<decltype(std::declval<const Basis&>().metric())>;
};

/// Asserts metric, basis and solver in turn: first the members of each, then its concept, which also checks their
/// types.
template <class Basis, class Solver>
struct decomposition_parts {
  using metric = typename metric_of<Basis>::type;
  static constexpr bool channelwise = requires(const Basis& functions) { functions.channel(Eigen::Index{}); };

  static_assert(!std::is_void_v<metric>, "decomposition: the basis has no metric()");
  static_assert(
      requires(const metric& map) { map.forward(1.0, Eigen::Index{}); },
      "decomposition: the metric of the basis has no forward(rho, cell)");
  static_assert(
      requires(const metric& map) { map.inverse(1.0, Eigen::Index{}); },
      "decomposition: the metric of the basis has no inverse(y, cell)");
  static_assert(error_metric<metric>, "decomposition: the metric of the basis is not a gonio::error_metric");

  static_assert(
      requires(const Basis& functions) { functions.size(); }, "decomposition: the basis has no size()");
  static_assert(
      requires(const Basis& functions) { functions.cells(); }, "decomposition: the basis has no cells()");
  static_assert(
      channelwise || requires(const Basis& functions) { functions.offset(Eigen::Index{}); },
      "decomposition: the basis has no offset(cell)");
  static_assert(
      channelwise || requires(const Basis& functions) { functions.row(Eigen::Index{}); } ||
          requires(const Basis& functions, const location& at, function_row out) { functions.read_row(at, out); },
      "decomposition: the basis has neither row(cell) nor read_row(location, out)");
  static_assert(colour_basis<Basis>,
                "decomposition: the basis is neither a gonio::basis nor a gonio::channelwise_basis");

  static_assert(
      requires(const Solver& any, const least_squares_problem& problem) { any.solve(problem); },
      "decomposition: the solver has no solve(problem)");
  static_assert(solver<Solver>, "decomposition: the solver is not a gonio::solver");
};

}  // namespace gonio::detail
