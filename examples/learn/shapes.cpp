/// Learns a shape model from sixty synthetic ear canals and fills the hole in the scan of another one.

#include "synthetic/ear_canal_scans.hpp"
#include <gonio/shape.hpp>

#include <cstdio>
#include <string>
#include <vector>

int main() {
  // The same 500 vertices in each of 60 shapes. Read your own from files with gonio::io::read_mesh.
  const synthetic::ear_canal_family family;
  const synthetic::ear_canal_template common{500};
  std::vector<gonio::shape::point_columns> shapes;
  std::vector<std::string> names;
  for (std::uint64_t i = 0; i < 60; ++i) {
    shapes.push_back(common.corresponded(family.draw(i)));
    names.push_back("ear " + std::to_string(i));
  }
  const gonio::shape::shape_model model = gonio::shape::learn_shape_model(shapes, names, common.mesh().triangles);

  synthetic::scan_options how;
  how.hole = synthetic::hole_options::large();
  const synthetic::ear_scan ear = synthetic::scan_of(family.draw(5001), common, 1, how);

  const gonio::shape::surface_index scan(ear.mesh);
  const auto pose = gonio::shape::align_by_shape_context(scan.mesh(), model.mean()).transform;
  const gonio::shape::recovered_shape found = gonio::shape::recover(model, scan, pose);
  // Transform the result from the model's space to the scan's.
  const gonio::shape::point_columns vertices = found.pose.inverse()(found.surface.vertices);

  std::vector<Eigen::Index> hole;
  for (std::size_t v = 0; v < ear.covered.size(); ++v)
    if (!ear.covered[v]) hole.push_back(v);
  const gonio::shape::surface_index truth(ear.complete);
  const gonio::shape::point_columns mean = found.pose.inverse()(model.mean().vertices);
  std::printf("%zu of %zu vertices are in the hole\n", hole.size(), ear.covered.size());
  std::printf("there the mean shape is %.3f mm from the truth, the recovered one %.3f mm\n",
              gonio::shape::distance_to(truth, gonio::shape::point_columns(mean(Eigen::all, hole))).absolute_mean,
              gonio::shape::distance_to(truth, gonio::shape::point_columns(vertices(Eigen::all, hole))).absolute_mean);
}
