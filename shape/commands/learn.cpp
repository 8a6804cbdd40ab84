/// gonio shape learn: learns an active shape model from corresponded meshes and from scans, which it registers.

#include "shape.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/shape/bootstrap.hpp>
#include <gonio/shape/io/mesh.hpp>
#include <gonio/shape/io/shape_model.hpp>

#include <iostream>
#include <memory>

namespace cli {

namespace {

struct shape_learn_command {
  std::vector<std::filesystem::path> shapes, scans;
  std::filesystem::path output;
  gonio::thread_count threads;
};

/// Returns the vertices of meshes with the same triangles as the first.
std::vector<gonio::shape::point_columns> read_corresponded(const std::vector<std::filesystem::path>& files,
                                                           gonio::shape::triangle_columns& triangles) {
  std::vector<gonio::shape::point_columns> shapes;
  for (const auto& file : files) {
    gonio::shape::triangle_mesh mesh = gonio::io::read_mesh(file);
    if (shapes.empty()) triangles = mesh.triangles;
    const bool same = mesh.triangles.cols() == triangles.cols() && mesh.triangles == triangles;
    if (!same || (!shapes.empty() && mesh.vertices.cols() != shapes[0].cols()))
      gonio::refuse(file.string() + ": does not have the vertices and triangles of " + files[0].string() +
                    ", expected shapes in correspondence");
    shapes.push_back(std::move(mesh.vertices));
  }
  return shapes;
}

void learn_shapes(const shape_learn_command& options) {
  gonio::shape::triangle_columns triangles;
  std::vector<std::string> names;
  for (const auto& file : options.shapes) names.push_back(file.stem().string());
  std::vector<gonio::shape::point_columns> shapes = read_corresponded(options.shapes, triangles);
  if (options.scans.empty()) {
    const auto model = gonio::shape::learn_shape_model(shapes, names, triangles, options.threads);
    gonio::io::write_shape_model(options.output, model);
    std::cout << model.shapes() << " shapes of " << model.vertices() << " vertices; "
              << model.truncated_to_variance(0.99).basis().size() << " components explain 99 %\n";
    return;
  }
  std::vector<gonio::shape::named_scan> scans;
  for (const auto& file : options.scans) scans.push_back({file.stem().string(), gonio::io::read_mesh(file)});
  progress_bar bar;
  const auto grown = gonio::shape::bootstrap_shape_model(
      std::move(shapes), std::move(names), std::move(triangles), scans, {}, options.threads,
      [&](std::string_view stage, double done) { bar.draw(stage, done); });
  bar.wipe();
  gonio::io::write_shape_model(options.output, grown.model);
  for (std::size_t i = 0; i < scans.size(); ++i)
    std::cout << scans[i].name << ": "
              << (grown.outcomes[i].accepted() ? "accepted" : "refused, " + grown.outcomes[i].refusal) << '\n';
  std::cout << grown.accepted() << " of " << scans.size() << " scans accepted, the model has " << grown.model.shapes()
            << " shapes\n";
}

}  // namespace

void add_shape_learn(command& shape) {
  auto command = shape.add_subcommand("learn", "Learn a model of shapes in correspondence, and grow it by scans");
  const auto options = std::make_shared<shape_learn_command>();
  command
      .add_input("shapes", options->shapes,
                 "Meshes in mm whose vertices correspond and whose triangles are the same (.ply, .obj)")
      .required();
  command.add_input("--scans", options->scans, "Scans of any triangulation, to register and learn from");
  add_threads_option(command, options->threads);
  command.add_output("-o,--output", options->output, {".shapes"}, "Model to write (.shapes)").required();
  command.callback([options] { learn_shapes(*options); });
}

}  // namespace cli
