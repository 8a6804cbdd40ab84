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
  std::cout << "expected error of these (root mean square, " << uncertainty.trials()
            << " shapes left out): " << fixed(std::sqrt(across / count), 3) << " mm across the surface, "
            << fixed(std::sqrt(all / count), 3) << " mm including sliding along it\n";
}

/// Returns the initial pose: as given, or by shape context.
gonio::shape::similarity_transform begin_pose(const shape_recover_command& options,
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
  // Recover the shape, and bring it into the frame of the model.
  const gonio::shape::surface_index index = in_file(options.scan, [&] { return gonio::shape::surface_index(scan); });
  const gonio::shape::similarity_transform pose = begin_pose(options, model, scan);
  const gonio::shape::recovered_shape found =
      in_file(options.scan, [&] { return gonio::shape::recover(model, index, pose, how, options.threads); });
  gonio::shape::triangle_mesh recovered = model.mesh(found.pose.inverse()(found.surface.vertices));

  // List the vertices that the scan does not show.
  const std::vector<bool> known = gonio::shape::marks_of(found.known, model.vertices());
  std::vector<Eigen::Index> missing;
  for (Eigen::Index v = 0; v < model.vertices(); ++v)
    if (!known[v]) missing.push_back(v);
  std::cout << missing.size() << " of " << model.vertices() << " vertices are recovered\n";
  // Estimate their uncertainty by trials.
  if (options.trials > 0 && !missing.empty())
    print_how_sure({model, index, found, {.trials = options.trials, .recovery = how}, options.threads}, found.surface,
                   missing);
  // Compare them with the truth, if there is one.
  Eigen::VectorXd distances;
  std::vector<gonio::rgb> colours;
  if (!options.truth.empty()) {
    gonio::shape::triangle_mesh whole = gonio::io::read_mesh(options.truth);
    const auto truth = in_file(options.truth, [&] { return gonio::shape::surface_index(std::move(whole)); });
    distances = gonio::shape::signed_distances(truth, recovered.vertices, options.threads);
    for (const double distance : distances) colours.push_back(gonio::render::false_colour(distance, {-0.5, 0.5}));
    if (!missing.empty()) {
      const auto off = gonio::shape::surface_distance::of(distances(missing));
      std::cout << "distance of these from the truth: signed mean " << fixed(off.signed_mean, 3) << " mm, absolute "
                << fixed(off.absolute_mean, 3) << " mm, largest " << fixed(off.largest, 3) << " mm\n";
    }
  }
  // Write the pose, the mesh coloured by its distance from the truth, and the image.
  if (!options.found_pose.empty()) gonio::io::write_pose(options.found_pose, found.pose);
  if (colours.empty())
    gonio::io::write_mesh(options.output, recovered);
  else
    gonio::io::write_mesh(options.output, recovered, colours);
  if (!options.image.empty()) gonio::io::write_png(options.image, shape_image(found.surface, distances, 0.5));
}

}  // namespace

void add_shape_recover(command& shape) {
  auto command = shape.add_subcommand("recover", "Recover what a scan does not show");
  const auto options = std::make_shared<shape_recover_command>();
  command.add_input("scan", options->scan, "In mm, its vertical axis y (.ply, .obj)").required();
  command.add_input("--model", options->model, "From gonio shape learn").required();
  command.add_option("--noise", options->noise, "Of the scan, mm")
      .check(check::range(1e-4, 10.0))
      .capture_default_str();
  auto pose = command.add_input("--pose", options->pose,
                                "Where the scan lies, from it to the model, instead of finding it by its shape (.txt, "
                                "docs/reference/formats.md)");
  auto hold = command
                  .add_flag("--hold-pose", options->holds_pose,
                            "The pose is right as it is: it is not fitted together with the shape")
                  .needs(pose);
  command
      .add_option("--trials", options->trials,
                  "Shapes of the model to leave out and recover, to tell how sure this is; 0 for none, else 10 or more")
      .check(check::range(0, 100000))
      .excludes(hold)
      .capture_default_str();
  command.add_input("--truth", options->truth, "The whole surface, to compare with");
  command.add_output("--image", options->image, {".png"}, "The recovered surface from two sides (.png)");
  command.add_output("--found-pose", options->found_pose, {".txt"},
                     "The pose that was found, from the scan to the model, to write (.txt)");
  add_threads_option(command, options->threads);
  command
      .add_output("-o,--output", options->output, {".ply", ".obj"},
                  "Recovered surface to write (.ply, or without --truth .obj), coloured by its distance from the truth")
      .required();
  command.callback([options] { recover_shape(*options); });
}

}  // namespace cli
