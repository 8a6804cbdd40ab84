/// gonio shape see, then gonio sphere: turns a simulated photograph of a mesh into samples.

#include "cli/tool.hpp"
#include "io/scratch.hpp"
#include "lab/sphere_lab.hpp"
#include <gonio/io/images/image.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/io/setups/sphere_setup.hpp>
#include <gonio/model/formula_materials.hpp>
#include <gonio/shape/io/mesh.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

namespace {

const std::string mesh_scene =
    "size 128 128\nfield_of_view 11.5\ndistortion -0.25 0.1 0.002 -0.001\nposition 0 0 12\ntarget 0 0 0\nup 0 1 0\n"
    "lamp 13.1 0 7.3\nintensity 700\n";

/// Returns a sphere of rings, with its poles on the x axis.
gonio::shape::triangle_mesh sphere_of_rings(const Eigen::Vector3d& centre, int rings) {
  const int around = 2 * rings;
  gonio::shape::triangle_mesh mesh;
  mesh.vertices.resize(3, (rings + 1) * around);
  mesh.triangles.resize(3, 2 * rings * around);
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < around; ++j) {
      const gonio::direction at =
          gonio::spherical_direction(std::numbers::pi * i / rings, 2.0 * std::numbers::pi * j / around);
      mesh.vertices.col(i * around + j) = centre + Eigen::Vector3d(at.z(), at.x(), at.y());
    }
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < around; ++j) {
      const int a = i * around + j, b = i * around + (j + 1) % around;
      mesh.triangles.col(2 * a) = Eigen::Vector3i(a, a + around, b + around);
      mesh.triangles.col(2 * a + 1) = Eigen::Vector3i(a, b + around, b);
    }
  return mesh;
}

}  // namespace

TEST_CASE("a photograph of a mesh becomes samples of the paint") {
  const scratch::folder here;
  const auto at = [&](const std::string& name) { return (here / name).string(); };
  const auto paint = gonio::model::formula_material("red-paint");
  const Eigen::Vector3d centre(0.02, -0.03, 0.0);
  scratch::put(here / "setup.txt", mesh_scene);
  const auto setup = gonio::io::read_sphere_setup(at("setup.txt"));
  gonio::io::write_hdr(at("paint.hdr"), lab::photograph(paint, {centre, 1.0}, setup.camera,
                                                        std::get<gonio::capture::point_lamp>(setup.light)));
  gonio::io::write_mesh(at("sphere.ply"), sphere_of_rings(centre, 60));

  const std::string see = "shape see " + at("sphere.ply") + " ";
  const std::string maps = " --normals " + at("normals.npy") + " --positions " + at("positions.npy");
  const auto seen = gonio_tool(see + at("setup.txt") + maps);
  REQUIRE_MESSAGE(seen.exit_code == 0, seen.output);
  CHECK(seen.output.find(" of 16384 pixels see the mesh") != std::string::npos);
  const auto run = gonio_tool("sphere " + at("paint.hdr") + " " + at("setup.txt") + maps + " -o " + at("samples.csv"));
  REQUIRE_MESSAGE(run.exit_code == 0, run.output);
  std::vector<double> off;
  for (const gonio::sample& s : gonio::io::read_samples(at("samples.csv"))) {
    const auto [wi, wo] = s.directions.pair();
    off.push_back(std::abs(s.value.x() / paint(wi, wo).x() - 1.0));
  }
  REQUIRE(off.size() > 500);
  std::ranges::nth_element(off, off.begin() + std::ssize(off) / 2);
  CHECK(off[off.size() / 2] < 0.02);

  scratch::put(here / "away.txt",
               "size 8 8\nfield_of_view 10\nposition 0 0 12\ntarget 0 0 24\nup 0 1 0\nlight 0 0 1\n");
  const auto away = gonio_tool(see + at("away.txt") + " --normals " + at("no.npy") + " --positions " + at("none.npy"));
  CHECK(away.exit_code == 2);
  CHECK(away.output.find("does not see the mesh") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(here / "no.npy"));
}
