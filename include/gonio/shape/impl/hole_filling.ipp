#pragma once
/// Bodies of shape/hole_filling.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/shape/hole_filling.hpp>
#include <gonio/shape/mesh_topology.hpp>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <vector>

namespace gonio::detail {

GONIO_INLINE std::vector<int> along_border(const mesh_topology& topology, Eigen::Index vertex) {
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

GONIO_INLINE Eigen::SparseMatrix<double> umbrella_rows(const mesh_topology& topology) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index v = 0; v < topology.vertices(); ++v) {
    const auto all = topology.neighbours(v);
    const std::vector<int> around =
        topology.on_border(v) ? along_border(topology, v) : std::vector<int>(all.begin(), all.end());
    if (around.empty()) continue;  // in no triangle
    entries.emplace_back(static_cast<int>(v), static_cast<int>(v), -1.0);
    for (const int other : around)
      entries.emplace_back(static_cast<int>(v), other, 1.0 / static_cast<double>(around.size()));
  }
  Eigen::SparseMatrix<double> rows(topology.vertices(), topology.vertices());
  rows.setFromTriplets(entries.begin(), entries.end());
  return rows;
}

GONIO_INLINE Eigen::SparseMatrix<double> energy_matrix(const mesh_topology& topology, smoothness kind) {
  if (kind == smoothness::thin_plate) {
    const Eigen::SparseMatrix<double> rows = umbrella_rows(topology);
    return rows.transpose() * rows;
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index v = 0; v < topology.vertices(); ++v) {
    const auto around = topology.neighbours(v);
    entries.emplace_back(static_cast<int>(v), static_cast<int>(v), static_cast<double>(around.size()));
    for (const int other : around) entries.emplace_back(static_cast<int>(v), other, -1.0);
  }
  Eigen::SparseMatrix<double> laplacian(topology.vertices(), topology.vertices());
  laplacian.setFromTriplets(entries.begin(), entries.end());
  return laplacian;
}

GONIO_INLINE void require_reached(const mesh_topology& topology, std::vector<bool> reached) {
  std::vector<Eigen::Index> pending;
  for (Eigen::Index v = 0; v < topology.vertices(); ++v)
    if (reached[static_cast<std::size_t>(v)]) pending.push_back(v);
  if (pending.empty()) throw error("no vertex is known: there is nothing to fill holes from");
  while (!pending.empty()) {
    const Eigen::Index vertex = pending.back();
    pending.pop_back();
    for (const int neighbour : topology.neighbours(vertex)) {
      if (reached[static_cast<std::size_t>(neighbour)]) continue;
      reached[static_cast<std::size_t>(neighbour)] = true;
      pending.push_back(neighbour);
    }
  }
  const auto lost = std::ranges::find(reached, false);
  if (lost != reached.end())
    throw error("vertex " + std::to_string(lost - reached.begin()) +
                " cannot be filled in: no known vertex is in its part of the mesh");
}

GONIO_INLINE Eigen::SparseMatrix<double> columns_at(const Eigen::SparseMatrix<double>& matrix,
                                                    const std::vector<Eigen::Index>& places) {
  Eigen::SparseMatrix<double> chosen(matrix.cols(), static_cast<Eigen::Index>(places.size()));
  std::vector<Eigen::Triplet<double>> ones;
  for (std::size_t i = 0; i < places.size(); ++i)
    ones.emplace_back(static_cast<int>(places[i]), static_cast<int>(i), 1.0);
  chosen.setFromTriplets(ones.begin(), ones.end());
  return matrix * chosen;
}

}  // namespace gonio::detail

namespace gonio {

GONIO_INLINE point_columns fill_smoothly(const mesh_topology& topology, point_columns points,
                                         const std::vector<bool>& known, smoothness kind) {
  const Eigen::Index vertices = topology.vertices();
  if (points.cols() != vertices || static_cast<Eigen::Index>(known.size()) != vertices)
    throw error("a mesh of " + std::to_string(vertices) + " vertices has " + std::to_string(points.cols()) +
                " points and " + std::to_string(known.size()) + " marks of known ones");
  detail::require_reached(topology, known);
  std::vector<Eigen::Index> missing;
  for (Eigen::Index v = 0; v < vertices; ++v) {
    const bool is_known = known[static_cast<std::size_t>(v)];
    if (is_known && !points.col(v).allFinite())
      throw error("the position of known vertex " + std::to_string(v) + " is not finite");
    if (is_known) continue;
    missing.push_back(v);
    points.col(v).setZero();  // and leaves the right-hand side to the known ones
  }
  if (missing.empty()) return points;

  const Eigen::SparseMatrix<double> energy = detail::energy_matrix(topology, kind),
                                    columns = detail::columns_at(energy, missing), rows = columns.transpose(),
                                    system = detail::columns_at(rows, missing);
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(system);
  const bool determined =
      factors.info() == Eigen::Success && factors.vectorD().minCoeff() > 1e-12 * factors.vectorD().maxCoeff();
  if (!determined) throw error("the known vertices do not determine where the missing ones are");
  const Eigen::MatrixXd right = -(rows * points.transpose()), filled = factors.solve(right);
  for (std::size_t i = 0; i < missing.size(); ++i)
    points.col(missing[i]) = filled.row(static_cast<Eigen::Index>(i)).transpose();
  return points;
}

}  // namespace gonio
