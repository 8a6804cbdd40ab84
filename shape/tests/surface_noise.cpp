#include "synthetic_surfaces.hpp"
#include <gonio/shape/surface_noise.hpp>

#include <doctest/doctest.h>

#include <cmath>

namespace {

/// Returns a mesh with uniform noise of a standard deviation along the normals.
gonio::shape::triangle_mesh with_noise(gonio::shape::triangle_mesh mesh, double deviation, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  const gonio::shape::point_columns normals = gonio::shape::vertex_normals(mesh);
  for (Eigen::Index v = 0; v < normals.cols(); ++v)
    mesh.vertices.col(v) += deviation * std::sqrt(12.0) * (synthetic_number(generator) - 0.5) * normals.col(v);
  return mesh;
}

double root_mean_noise(const gonio::shape::triangle_mesh& mesh) {
  return std::sqrt(gonio::shape::noise_variances(mesh, gonio::shape::mesh_topology(mesh)).mean());
}

}  // namespace

TEST_CASE("the noise of a curved surface is found without its curvature") {
  const gonio::shape::triangle_mesh smooth = sphere_mesh(4, 5.0);
  CHECK(root_mean_noise(smooth) < 0.002);
  for (const double deviation : {0.02, 0.05, 0.1})
    CHECK(root_mean_noise(with_noise(smooth, deviation, 1)) == doctest::Approx(deviation).epsilon(0.1));
}

TEST_CASE("noise is found where it is") {
  gonio::shape::triangle_mesh mesh = flat_grid(30, 40);
  const gonio::shape::triangle_mesh noisy = with_noise(mesh, 0.1, 2);
  for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v)
    if (mesh.vertices(0, v) >= 20.0) mesh.vertices.col(v) = noisy.vertices.col(v);
  const Eigen::RowVectorXd variances = gonio::shape::noise_variances(mesh, gonio::shape::mesh_topology(mesh));
  double rough = 0.0;
  Eigen::Index count = 0;
  for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v) {
    if (mesh.vertices(0, v) < 16.0) CHECK(variances[v] == 0.0);
    if (mesh.vertices(0, v) < 24.0) continue;
    rough += variances[v];
    ++count;
  }
  CHECK(std::sqrt(rough / static_cast<double>(count)) == doctest::Approx(0.1).epsilon(0.15));
}

TEST_CASE("means over neighbours keep the border of a plane on the border") {
  const gonio::shape::triangle_mesh mesh = flat_grid(5, 6);
  const gonio::shape::mesh_topology topology(mesh);
  const gonio::shape::point_columns means = gonio::shape::averaged_over_neighbours(topology, mesh.vertices);
  for (Eigen::Index v = 0; v < means.cols(); ++v) {
    CHECK(means(2, v) == 0.0);
    if (mesh.vertices(1, v) == 0.0) CHECK(means(1, v) <= 1.0 / 3.0);
    if (!topology.on_border(v)) CHECK((means.col(v) - mesh.vertices.col(v)).norm() < 1e-12);
  }
}
