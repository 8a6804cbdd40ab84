/// gonio shape see: maps of the normals and positions of a mesh that a camera sees, for `gonio sphere --normals`.

#include "shape.hpp"
#include <gonio/io/bytes/npy.hpp>
#include <gonio/io/setups/camera_calibration.hpp>
#include <gonio/io/setups/sphere_setup.hpp>
#include <gonio/shape/io/mesh.hpp>
#include <gonio/shape/mesh_surface.hpp>

#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

namespace cli {

namespace {

struct see_command {
  std::filesystem::path mesh, setup, calibration, normals, positions;
};

void write_map(const std::filesystem::path& path, const Eigen::Matrix3Xd& vectors, const gonio::surface_image& seen) {
  gonio::capture::vector_map map({seen.rows, seen.columns, 3});
  for (Eigen::Index i = 0; i < vectors.size(); ++i) map.data()[i] = static_cast<float>(vectors.data()[i]);
  gonio::io::write_npy(path, map);
}

void run(const see_command& options) {
  std::optional<gonio::io::camera_calibration> calibration;
  if (!options.calibration.empty()) calibration = gonio::io::read_camera_calibration(options.calibration);
  const gonio::io::sphere_setup setup = gonio::io::read_sphere_setup(options.setup, calibration);
  const gonio::surface_image seen = gonio::shape::surface_of(gonio::io::read_mesh(options.mesh), setup.camera);
  Eigen::Index pixels = 0;
  for (Eigen::Index pixel = 0; pixel < seen.normals.cols(); ++pixel) pixels += seen.sees(pixel) ? 1 : 0;
  if (pixels == 0)
    gonio::refuse({options.mesh.string(), ": the camera of ", options.setup.string(), " does not see the mesh"});
  write_map(options.normals, seen.normals, seen);
  write_map(options.positions, seen.positions, seen);
  std::cout << pixels << " of " << seen.normals.cols() << " pixels see the mesh\n";
}

}  // namespace

void add_shape_see(command& shape) {
  auto command = shape.add_subcommand("see", "Write maps of the mesh that a camera sees, for gonio sphere --normals");
  const auto options = std::make_shared<see_command>();
  command.add_input("mesh", options->mesh, "The surface in the camera's world (.ply or .obj)").required();
  command
      .add_input("setup", options->setup,
                 "Set-up of the photograph, as for gonio sphere but without the entry 'sphere'")
      .required();
  command.add_input("--calibration", options->calibration,
                    "Camera and lens distortion as OpenCV writes them (.yml or .xml), instead of those in the set-up");
  command.add_output("--normals", options->normals, {".npy"}, "File to write: the normal at each pixel (.npy)")
      .required();
  command.add_output("--positions", options->positions, {".npy"}, "File to write: the position at each pixel (.npy)")
      .required();
  command.callback([options] { run(*options); });
}

}  // namespace cli
