#pragma once
/// How noisy a scan is, place by place, told from the scan alone.

#include <gonio/shape/mesh_topology.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <Eigen/Core>

namespace gonio::shape {

/// Each column replaced by the mean of itself and its neighbours. Vertices on the border have neighbours on the border
/// alone, lest the surface shrink.
[[nodiscard]] point_columns averaged_over_neighbours(const mesh_topology& topology, const point_columns& values);
[[nodiscard]] Eigen::RowVectorXd averaged_over_neighbours(const mesh_topology& topology,
                                                          const Eigen::RowVectorXd& values);

/// The variance of the noise along the normals about each vertex, in the squared unit of the mesh.
///
/// Taking means over neighbours away twice leaves nothing of a smooth surface but its fourth derivatives, and all of
/// what differs from vertex to vertex: of independent noise the variance itself, within a few percent, where five to
/// seven edges meet. Two more means gather it from about nineteen vertices. O(vertices + edges).
[[nodiscard]] Eigen::RowVectorXd noise_variances(const triangle_mesh& mesh, const mesh_topology& topology);

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/surface_noise.ipp>
#endif
