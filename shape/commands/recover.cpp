/// gonio shape recover: recovers the missing parts of a partial scan.

#include "shape.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include <gonio/io/images/image.hpp>
#include <gonio/render/false_colour.hpp>
#include <gonio/shape/cross_validated_uncertainty.hpp>
#include <gonio/shape/io/mesh.hpp>
#include <gonio/shape/io/pose.hpp>
#include <gonio/shape/io/shape_model.hpp>
#include <gonio/shape/recovery.hpp>
#include <gonio/shape/surface_distance.hpp>

#include <cmath>
#include <iostream>
#include <memory>

namespace cli {

namespace {

struct shape_recover_command {
  std::filesystem::path scan, model, output, truth, image, pose, found_pose;
  double noise = 0.05;
  bool holds_pose = false;
  Eigen::Index trials = 0;
  gonio::thread_count threads;
};

/// Prefixes errors with the file's name.
template <class Work>
auto in_file(const std::filesystem::path& file, Work&& work) {
  try {
    return work();
  } catch (const gonio::error& refusal) {
    gonio::refuse(file.string() + ": " + refusal.what());
  }
}

/// Prints the expected errors of vertices, measured by leaving shapes of the model out.
void print_how_sure(const gonio::shape::cross_validated_uncertainty& uncertainty,
                    const gonio::shape::triangle_mesh& recovered, const std::vector<Eigen::Index>& vertices) {
  const gonio::shape::point_columns normals = gonio::shape::vertex_normals(recovered);
  double across = 0.0, all = 0.0;
  for (const Eigen::Index vertex : vertices) {
    const Eigen::Matrix3d covariance = uncertainty.covariance(vertex);
    across += normals.col(vertex).dot(covariance * normals.col(vertex));
    all += covariance.trace();
  }
  const auto count = static_cast<double>(vertices.size());
  std::cout << "expected error of the recovered vertices (root mean square, " << uncertainty.trials()
            << " shapes left out): " << fixed(std::sqrt(across / count), 3) << " mm across the surface, "
            << fixed(std::sqrt(all / count), 3) << " mm including sliding along it\n";
}

/// Returns the initial pose: as given, or by shape context.
gonio::shape::similarity_transform initial_pose(const shape_recover_command& options,
                                                const gonio::shape::shape_model& model,
                                                const gonio::shape::triangle_mesh& scan) {
  if (!options.pose.empty()) return gonio::io::read_pose(options.pose);
  return in_file(options.scan, [&] { return find_pose(model, scan, options.threads); });
}

void recover_shape(const shape_recover_command& options) {
  // Read the model and the scan.
  const gonio::shape::shape_model model = gonio::io::read_shape_model(options.model);
  const gonio::shape::triangle_mesh scan = gonio::io::read_mesh(options.scan);
  gonio::shape::recovery_options how;
  how.fine.position_error = options.noise;
  how.coarse.holds_pose = how.fine.holds_pose = options.holds_pose;
  // Recover the shape in the scan's coordinates.
  const gonio::shape::surface_index index = in_file(options.scan, [&] { return gonio::shape::surface_index(scan); });
  const gonio::shape::similarity_transform pose = initial_pose(options, model, scan);
  const gonio::shape::recovered_shape found =
      in_file(options.scan, [&] { return gonio::shape::recover(model, index, pose, how, options.threads); });
  gonio::shape::triangle_mesh recovered = model.mesh(found.pose.inverse()(found.surface.vertices));

  // List the vertices that the scan does not show.
  const std::vector<bool> known = gonio::shape::marks_of(found.known, model.vertices());
  std::vector<Eigen::Index> missing;
  for (Eigen::Index v = 0; v < model.vertices(); ++v)
    if (!known[v]) missing.push_back(v);
  std::cout << missing.size() << " of " << model.vertices() << " vertices are recovered\n";
  // Estimate the uncertainty of the missing vertices by trials.
  if (options.trials > 0 && !missing.empty())
    print_how_sure({model, index, found, {.trials = options.trials, .recovery = how}, options.threads}, found.surface,
                   missing);
  // Compare with the truth, if there is one.
  Eigen::VectorXd distances;
  std::vector<gonio::rgb> colours;
  if (!options.truth.empty()) {
    gonio::shape::triangle_mesh whole = gonio::io::read_mesh(options.truth);
    const auto truth = in_file(options.truth, [&] { return gonio::shape::surface_index(std::move(whole)); });
    distances = gonio::shape::signed_distances(truth, recovered.vertices, options.threads);
    for (const double distance : distances) colours.push_back(gonio::render::diverging_colour(distance, 0.5));
    if (!missing.empty()) {
      const auto off = gonio::shape::surface_distance::of(distances(missing));
      std::cout << "distance of the recovered vertices from the truth: signed mean " << fixed(off.signed_mean, 3)
                << " mm, absolute " << fixed(off.absolute_mean, 3) << " mm, largest " << fixed(off.largest, 3)
                << " mm\n";
    }
  }
  // Write the pose, the mesh (coloured by its distance from the truth, if there is one), and the image.
  if (!options.found_pose.empty()) gonio::io::write_pose(options.found_pose, found.pose);
  if (colours.empty())
    gonio::io::write_mesh(options.output, recovered);
  else
    gonio::io::write_mesh(options.output, recovered, colours);
  if (!options.image.empty()) gonio::io::write_png(options.image, shape_image(found.surface, distances, 0.5));
}

}  // namespace

void add_shape_recover(command& shape) {
  auto command = shape.add_subcommand("recover", "Recover the missing parts of a scan");
  const auto options = std::make_shared<shape_recover_command>();
  command.add_input("scan", options->scan, "Scan in mm, with y as its vertical axis (.ply, .obj)").required();
  command.add_input("--model", options->model, "Model that gonio shape learn wrote (.shapes)").required();
  command.add_option("--noise", options->noise, "Noise of the scan, mm")
      .check(check::range(1e-4, 10.0))
      .capture_default_str();
  auto pose =
      command.add_input("--pose", options->pose,
                        "File of the initial pose, from scan to model (.txt, docs/reference/formats.md). Default: "
                        "found by shape context");
  auto hold = command
                  .add_flag("--hold-pose", options->holds_pose,
                            "Keep the initial pose instead of fitting it together with the shape")
                  .needs(pose);
  command
      .add_option(
          "--trials", options->trials,
          "Number of the model's shapes to leave out and recover, to measure the uncertainty: 0, or at least 10")
      .check(check::range(0, 100000))
      .excludes(hold)
      .capture_default_str();
  command.add_input("--truth", options->truth, "True whole surface, to compare with");
  command.add_output("--image", options->image, {".png"},
                     "Image to write: the recovered surface from two sides (.png)");
  command.add_output("--found-pose", options->found_pose, {".txt"},
                     "File to write: the pose that was found, from scan to model (.txt)");
  add_threads_option(command, options->threads);
  command
      .add_output("-o,--output", options->output, {".ply", ".obj"},
                  "Recovered surface to write (.ply; without --truth, also .obj). With --truth, it is coloured by its "
                  "distance from the truth")
      .required();
  command.callback([options] { recover_shape(*options); });
}

}  // namespace cli
