/// gonio shape: recovers the missing parts of scanned surfaces from the statistics of many similar shapes.

#include "shape.hpp"

#include "tool/commands/commands.hpp"
#include "tool/pages/fixed.hpp"
#include <gonio/render/false_colour.hpp>
#include <gonio/render/image.hpp>

#include <array>

namespace cli {

gonio::image shape_image(const gonio::shape::triangle_mesh& mesh, const Eigen::VectorXd& distances, double largest,
                         std::size_t pixels) {
  std::vector<gonio::rgb> colours(mesh.vertices.cols(), gonio::rgb::Constant(0.5));
  for (Eigen::Index v = 0; v < distances.size(); ++v)
    colours[v] = gonio::render::diverging_colour(distances[v], largest);
  const auto from = [&](const Eigen::Vector3d& towards) {
    gonio::shape::mesh_view view = gonio::shape::mesh_view::of(mesh, towards);
    view.radius = 18.0;  // mm: the same scale for all ears
    view.pixels = pixels;
    return gonio::shape::image_of(mesh, colours, view);
  };
  const std::array both{from({0.0, -0.2, -1.0}), from({0.3, -1.0, 0.2})};
  return gonio::render::side_by_side(both);
}

gonio::shape::similarity_transform find_pose(const gonio::shape::shape_model& model,
                                             const gonio::shape::triangle_mesh& scan, gonio::thread_count threads) {
  const gonio::shape::pre_alignment found = gonio::shape::align_by_shape_context(scan, model.mean(), {}, threads);
  // The model's vertices in missing parts are far from the scan, so measure from the scan to the model.
  constexpr double largest = 5.0;
  if (found.mean_scan_distance > largest)
    gonio::refuse("the scan does not match the model: it is " + fixed(found.mean_scan_distance, 1) +
                  " mm away on average, expected at most " + fixed(largest, 1));
  return found.transform;
}

void add_shape(command& app) {
  auto shape = app.add_subcommand("shape", "Recover surfaces that scans show in part (docs/learn/shapes.md)");
  shape.require_subcommand();
  add_shape_learn(shape);
  add_shape_recover(shape);
  add_shape_demo(shape);
  add_shape_grow(shape);
  add_shape_see(shape);
}

}  // namespace cli
