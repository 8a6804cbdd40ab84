#pragma once
/// Bodies of shape/hole_filling.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/shape/hole_filling.hpp>
#include <gonio/shape/mesh_topology.hpp>

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

namespace gonio::shape::detail {

/// Returns the two neighbours along the border of a border vertex. Returns all its neighbours if it does not have
/// exactly two along the border, for example where three edges form a ring but no triangle.
[[nodiscard]] GONIO_INLINE std::vector<int> along_border(const mesh_topology& topology, Eigen::Index vertex) {
  const auto neighbours = topology.neighbours(vertex);
  std::vector<int> along, common;
  for (const int other : neighbours) {
    const auto theirs = topology.neighbours(other);
    common.clear();
    std::ranges::set_intersection(neighbours, theirs, std::back_inserter(common));
    if (topology.on_border(other) && common.size() == 1) along.push_back(other);
  }
  if (along.size() == 2) return along;
  return {neighbours.begin(), neighbours.end()};
}

/// A vertex and the factor of its position.
struct vertex_share {
  int vertex;
  double share;
};

/// A linear combination of vertices that should be short. The energy is the sum of its squared length over all terms.
using energy_term = std::vector<vertex_share>;

/// Returns the difference between each vertex and the mean of its neighbours. For a vertex on a border, only neighbours
/// along the border count: the mean of all neighbours lies inwards even on a plane, and would pull continued surfaces
/// back.
[[nodiscard]] GONIO_INLINE std::vector<energy_term> umbrella_terms(const mesh_topology& topology) {
  std::vector<energy_term> terms;
  for (Eigen::Index v = 0; v < topology.vertices(); ++v) {
    const auto all = topology.neighbours(v);
    const std::vector<int> around =
        topology.on_border(v) ? along_border(topology, v) : std::vector<int>(all.begin(), all.end());
    if (around.empty()) continue;  // the vertex is in no triangle
    energy_term term{{static_cast<int>(v), -1.0}};
    for (const int other : around) term.push_back({other, 1.0 / static_cast<double>(around.size())});
    terms.push_back(std::move(term));
  }
  return terms;
}

/// Returns the difference between each vertex and each of its neighbours with a higher number.
[[nodiscard]] GONIO_INLINE std::vector<energy_term> edge_terms(const mesh_topology& topology) {
  std::vector<energy_term> terms;
  for (Eigen::Index v = 0; v < topology.vertices(); ++v)
    for (const int other : topology.neighbours(v))
      if (other > v) terms.push_back({{static_cast<int>(v), 1.0}, {other, -1.0}});
  return terms;
}

/// Throws gonio::error for the first vertex that no path of edges joins to a known one.
GONIO_INLINE void require_reached(const mesh_topology& topology, std::vector<bool> reached) {
  std::vector<Eigen::Index> pending;
  for (Eigen::Index v = 0; v < topology.vertices(); ++v)
    if (reached[v]) pending.push_back(v);
  if (pending.empty()) refuse("no vertex is known: there is nothing to fill holes from");
  while (!pending.empty()) {
    const Eigen::Index vertex = pending.back();
    pending.pop_back();
    for (const int neighbour : topology.neighbours(vertex)) {
      if (reached[neighbour]) continue;
      reached[neighbour] = true;
      pending.push_back(neighbour);
    }
  }
  const auto lost = std::ranges::find(reached, false);
  if (lost != reached.end())
    refuse({"vertex ", lost - reached.begin(), " cannot be filled in: no known vertex is in its part of the mesh"});
}

/// The linear system of the missing vertices, in their order. `matrix` is the lower triangle of a symmetric matrix.
/// `rhs` is the contribution of the known vertices: x, y and z of one missing vertex per row.
struct filling_system {
  Eigen::SparseMatrix<double> matrix;
  Eigen::MatrixXd rhs;
};

[[nodiscard]] GONIO_INLINE filling_system system_of(const std::vector<energy_term>& terms, const point_columns& points,
                                                    const std::vector<Eigen::Index>& missing) {
  std::vector<int> number(points.cols(), -1);  // index among the missing
  for (Eigen::Index i = 0; i < std::ssize(missing); ++i) number[missing[i]] = static_cast<int>(i);
  const Eigen::Index count = std::ssize(missing);
  filling_system system{Eigen::SparseMatrix<double>(count, count), Eigen::MatrixXd::Zero(count, 3)};
  std::vector<Eigen::Triplet<double>> entries;
  for (const energy_term& term : terms)
    for (const vertex_share& one : term) {
      const int row = number[one.vertex];
      if (row < 0) continue;
      for (const vertex_share& other : term) {
        const int column = number[other.vertex];
        const double product = one.share * other.share;
        if (column < 0)
          for (Eigen::Index axis = 0; axis < 3; ++axis) system.rhs(row, axis) -= product * points(axis, other.vertex);
        else if (column <= row)
          entries.emplace_back(row, column, product);
      }
    }
  system.matrix.setFromTriplets(entries.begin(), entries.end());
  return system;
}

}  // namespace gonio::shape::detail

namespace gonio::shape {

GONIO_INLINE point_columns fill_smoothly(const mesh_topology& topology, point_columns points,
                                         const std::vector<bool>& known, smoothness kind) {
  const Eigen::Index vertices = topology.vertices();
  if (points.cols() != vertices || std::ssize(known) != vertices)
    refuse({"a mesh of ", vertices, " vertices has ", points.cols(), " points and ", known.size(),
            " marks of known vertices"});
  detail::require_reached(topology, known);
  std::vector<Eigen::Index> missing;
  for (Eigen::Index v = 0; v < vertices; ++v) {
    const bool is_known = known[v];
    if (is_known && !points.col(v).allFinite()) refuse({"the position of known vertex ", v, " is not finite"});
    if (!is_known) missing.push_back(v);
  }
  if (missing.empty()) return points;

  const auto [matrix, rhs] = detail::system_of(
      kind == smoothness::thin_plate ? detail::umbrella_terms(topology) : detail::edge_terms(topology), points,
      missing);
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(matrix);
  const bool determined =
      factors.info() == Eigen::Success && factors.vectorD().minCoeff() > 1e-12 * factors.vectorD().maxCoeff();
  if (!determined) refuse("the known vertices do not determine the missing ones");
  const Eigen::MatrixXd filled = factors.solve(rhs);
  for (Eigen::Index i = 0; i < std::ssize(missing); ++i)
    for (Eigen::Index axis = 0; axis < 3; ++axis) points(axis, missing[i]) = filled(i, axis);
  return points;
}

}  // namespace gonio::shape
