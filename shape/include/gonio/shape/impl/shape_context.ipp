#pragma once
/// Bodies of shape/shape_context.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/k_d_tree.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/shape/assignment.hpp>
#include <gonio/shape/shape_context.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

namespace gonio::shape::detail {

GONIO_INLINE void require_context(const shape_context_options& options) {
  if (options.radial_bins < 1 || options.polar_bins < 1 || options.azimuthal_bins < 1)
    refuse("a shape context needs at least one bin for each of its three coordinates");
  if (!(options.radius > 0.0 && std::isfinite(options.radius)))
    refuse({"the radius of a shape context must be positive and finite, not ", options.radius});
  if (!options.vertical.allFinite() || !(options.vertical.cwiseAbs().maxCoeff() > 0.0))
    refuse("the vertical axis of a shape context must be finite and not zero");
  if (!(options.least_inclination > 0.0 && options.least_inclination < std::numbers::pi / 2.0))
    refuse({"the least inclination of a shape context's normals must be between 0 and pi/2, not ",
            options.least_inclination});
}

/// Checks a mesh to sample and describe, which need not be a surface.
GONIO_INLINE void require_finite_mesh(const triangle_mesh& mesh) {
  if (!mesh.vertices.allFinite()) refuse("the vertices of a mesh to describe must be finite");
  if (mesh.triangles.cols() == 0) refuse("a mesh to describe has no triangles");
  if (mesh.triangles.minCoeff() < 0 || mesh.triangles.maxCoeff() >= mesh.vertices.cols())
    refuse({"a triangle of a mesh to describe names a vertex that does not exist, expected less than ",
            mesh.vertices.cols()});
}

/// Returns a third of the area of the triangles around each vertex.
[[nodiscard]] GONIO_INLINE Eigen::VectorXd vertex_areas(const triangle_mesh& mesh) {
  const point_columns normals = area_normals(mesh);  // length: twice the area
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(mesh.vertices.cols());
  for (Eigen::Index t = 0; t < normals.cols(); ++t) {
    const double share = normals.col(t).norm() / 6.0;
    for (Eigen::Index corner = 0; corner < 3; ++corner) areas[mesh.triangles(corner, t)] += share;
  }
  return areas;
}

struct point_tree::built_tree : k_d_tree<3> {
  using k_d_tree<3>::k_d_tree;
};

GONIO_INLINE point_tree::point_tree(const point_columns& points) : tree_(std::make_shared<const built_tree>(points)) {}

GONIO_INLINE double point_tree::squared_distance(const Eigen::Vector3d& point) const {
  std::uint32_t index = 0;
  double squared = 0.0;
  tree_->nearest(point.data(), 1, &index, &squared);
  return squared;
}

GONIO_INLINE std::vector<Eigen::Index> point_tree::within(double radius, const Eigen::Vector3d& centre) const {
  return tree_->within(radius, centre.data());
}

}  // namespace gonio::shape::detail

namespace gonio::shape {

GONIO_INLINE std::optional<Eigen::Matrix3d> context_frame(const Eigen::Vector3d& normal,
                                                          const shape_context_options& options) {
  const Eigen::Vector3d vertical = unit_vector(options.vertical);
  const Eigen::Vector3d across = vertical - vertical.dot(normal) * normal;
  if (!(normal.squaredNorm() > 0.0 && across.norm() >= std::sin(options.least_inclination))) return {};
  Eigen::Matrix3d frame;
  frame.col(0) = unit_vector(across);
  frame.col(1) = unit_vector(normal.cross(across));
  frame.col(2) = normal;
  return frame;
}

GONIO_INLINE Eigen::Index context_bin(const Eigen::Vector3d& point, const shape_context_options& options) {
  const auto bin = [](double share, Eigen::Index bins) {
    return std::clamp(static_cast<Eigen::Index>(share * static_cast<double>(bins)), Eigen::Index{0}, bins - 1);
  };
  const double r = point.norm(), theta = std::acos(std::clamp(point.z() / r, -1.0, 1.0)),
               phi = std::atan2(point.y(), point.x());
  const Eigen::Index radial = bin(r / options.radius, options.radial_bins),
                     polar = bin(theta / std::numbers::pi, options.polar_bins),
                     azimuthal = bin(0.5 + phi / (2.0 * std::numbers::pi), options.azimuthal_bins);
  return (radial * options.polar_bins + polar) * options.azimuthal_bins + azimuthal;
}

GONIO_INLINE std::vector<Eigen::Index> spread_vertices(const triangle_mesh& mesh, Eigen::Index count) {
  detail::require_finite_mesh(mesh);
  if (count < 0) refuse("the number of vertices to choose must not be negative");
  // Squared distances from the chosen vertices. Vertices of no triangle have distance 0, like chosen ones.
  const std::ptrdiff_t vertices = mesh.vertices.cols();
  std::vector<double> nearest(vertices, 0.0);
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t)
    for (Eigen::Index corner = 0; corner < 3; ++corner)
      nearest[mesh.triangles(corner, t)] = std::numeric_limits<double>::infinity();
  const auto nearer_of = [&](const Eigen::Vector3d& point) {
    std::vector<double> nearer = nearest;
    for (Eigen::Index v = 0; v < vertices; ++v) {
      double& square = nearer[v];
      const Eigen::Vector3d away = mesh.vertices.col(v) - point;
      square = std::min(square, away.squaredNorm());
    }
    return nearer;
  };
  std::vector<double> key = nearer_of(centroid_of(mesh.vertices));
  std::vector<Eigen::Index> chosen;
  while (std::ssize(chosen) < count) {
    const auto farthest = std::ranges::max_element(key);
    if (!(*farthest > 0.0)) break;
    chosen.push_back(farthest - key.begin());
    nearest = nearer_of(mesh.vertices.col(chosen.back()));
    key = nearest;
  }
  return chosen;
}

GONIO_INLINE shape_descriptors describe(const triangle_mesh& mesh, const std::vector<Eigen::Index>& chosen,
                                        const shape_context_options& options, thread_count threads) {
  // Refuse unusable options, meshes and vertices.
  detail::require_context(options);
  detail::require_finite_mesh(mesh);
  for (const Eigen::Index vertex : chosen)
    if (vertex < 0 || vertex >= mesh.vertices.cols())
      refuse({"vertex ", vertex, " of a mesh of ", mesh.vertices.cols(), " vertices does not exist"});
  // Prepare the normals, the area of each vertex and the search tree.
  const point_columns normals = vertex_normals(mesh);
  const Eigen::VectorXd areas = detail::vertex_areas(mesh);
  const detail::point_tree tree(mesh.vertices);
  Eigen::MatrixXd histograms = Eigen::MatrixXd::Zero(options.bins(), std::ssize(chosen));
  // For each vertex, add the areas of its neighbours to the bins of its own frame.
  const auto fill = [&](Eigen::Index point) {
    const Eigen::Index vertex = chosen[point];
    const Eigen::Vector3d origin = mesh.vertices.col(vertex);
    const std::optional<Eigen::Matrix3d> frame = context_frame(normals.col(vertex), options);
    if (!frame) return;
    for (const Eigen::Index neighbour : tree.within(options.radius, origin)) {
      const Eigen::Vector3d away = mesh.vertices.col(neighbour) - origin,
                            local(frame->col(0).dot(away), frame->col(1).dot(away), frame->col(2).dot(away));
      if (local.squaredNorm() > 0.0) histograms(context_bin(local, options), point) += areas[neighbour];
    }
  };
  for_each_index(
      chosen.size(), 8, [&](Eigen::Index i) { fill(i); }, threads);

  // Normalise the histograms, and skip empty ones.
  shape_descriptors found;
  std::vector<Eigen::Index> filled;
  for (Eigen::Index point = 0; point < histograms.cols(); ++point) {
    const double sum = histograms.col(point).sum();
    if (!(sum > 0.0)) continue;
    histograms.col(point) /= sum;
    filled.push_back(point);
    found.vertex.push_back(chosen[point]);
  }
  found.histograms.resize(histograms.rows(), std::ssize(filled));
  for (Eigen::Index i = 0; i < std::ssize(filled); ++i)
    found.histograms.col(i) = histograms.col(filled[i]).cast<float>();
  return found;
}

GONIO_INLINE Eigen::MatrixXd chi_square_costs(const shape_descriptors& from, const shape_descriptors& onto,
                                              thread_count threads) {
  if (from.histograms.rows() != onto.histograms.rows())
    refuse({"descriptors of ", from.histograms.rows(), " and ", onto.histograms.rows(), " bins cannot be compared"});
  Eigen::MatrixXd costs(from.histograms.cols(), onto.histograms.cols());
  // A bin that is empty in both descriptors contributes 0 / least, which is 0.
  constexpr float least = std::numeric_limits<float>::min();
  for_each_block(
      costs.cols(), 8,
      [&](block columns) {
        for (Eigen::Index j = columns.begin; j < columns.end; ++j)
          for (Eigen::Index i = 0; i < costs.rows(); ++i) {
            const auto a = from.histograms.col(i).array(), b = onto.histograms.col(j).array();
            costs(i, j) = 0.5 * ((a - b).square() / (a + b).max(least)).cast<double>().sum();
          }
      },
      threads);
  return costs;
}

GONIO_INLINE std::vector<shape_match> match(const shape_descriptors& from, const shape_descriptors& onto,
                                            thread_count threads) {
  const Eigen::MatrixXd costs = chi_square_costs(from, onto, threads);
  const std::vector<Eigen::Index> columns = optimal_assignment(costs);
  std::vector<shape_match> matches;
  for (Eigen::Index row = 0; row < costs.rows(); ++row) {
    const Eigen::Index column = columns[row];
    if (column >= 0) matches.push_back({row, column, costs(row, column)});
  }
  std::ranges::sort(matches, {}, [](const shape_match& one) { return std::tuple(one.cost, one.from); });
  return matches;
}

}  // namespace gonio::shape
