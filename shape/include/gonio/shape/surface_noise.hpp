#pragma once
/// Estimates the local noise of a scan from the scan alone.

#include <gonio/shape/mesh_topology.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <Eigen/Core>

namespace gonio::shape {

/// Replaces each column by the mean of itself and its neighbours. Border vertices use only neighbours on the border,
/// which keeps the surface from shrinking.
[[nodiscard]] point_columns averaged_over_neighbours(const mesh_topology& topology, const point_columns& values);
[[nodiscard]] Eigen::RowVectorXd averaged_over_neighbours(const mesh_topology& topology,
                                                          const Eigen::RowVectorXd& values);

/// Returns the variance of the noise along the normals about each vertex, in the squared unit of the mesh.
///
/// Subtracting means over neighbours twice leaves only fourth derivatives of a smooth surface, but nearly all of
/// independent noise. Where five to seven edges meet, the remainder has the variance of the noise within a few percent.
/// Two more means average the squared remainder over about nineteen vertices. O(vertices + edges).
[[nodiscard]] Eigen::RowVectorXd noise_variances(const triangle_mesh& mesh, const mesh_topology& topology);

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/surface_noise.ipp>
#endif
