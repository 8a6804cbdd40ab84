/// Simulated photographs of a sphere are converted to samples.

#include "../io/scratch.hpp"
#include "lab/sphere_lab.hpp"
#include "tool.hpp"
#include <gonio/capture/known_surface.hpp>
#include <gonio/io/bytes/npy.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/io/setups/sphere_setup.hpp>
#include <gonio/model/formula_materials.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <variant>
#include <vector>

namespace {

const std::string sphere_scene =
    "size 128 128\nfield_of_view 11.5\ndistortion -0.25 0.1 0.002 -0.001\nposition 0 0 12\ntarget 0 0 0\nup 0 1 0\n"
    "lamp 13.1 0 7.3\nintensity 700\n";

/// A photograph of a sphere with red paint, one of a white sphere, and a set-up.
class sphere_shots {
 public:
  sphere_shots() {
    scratch::put(at("setup.txt"), sphere_scene + "sphere 1\nwhite_reflectance 0.98\n");
    scratch::put(at("bare.txt"), sphere_scene);
    const auto setup = gonio::io::read_sphere_setup(at("setup.txt"));
    const gonio::capture::placed_sphere sphere{{0.02, -0.03, 0.0}, 1.0};
    const auto& lamp = std::get<gonio::capture::point_lamp>(setup.light);
    const lab::camera_defects dark{.vignetting = true};
    gonio::io::write_hdr(at("paint.hdr"), lab::photograph(paint, sphere, setup.camera, lamp, dark));
    gonio::io::write_hdr(at("white.hdr"), lab::photograph(lab::white_material{0.98}, sphere, setup.camera, lamp, dark));
    gonio::io::write_hdr(at("black.hdr"), gonio::uniform_image(128, 128));
  }

  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }

  const gonio::model::formula_brdf paint = gonio::model::formula_material("red-paint");

 private:
  scratch::folder folder_;
};

}  // namespace

TEST_CASE("a photograph of a sphere becomes samples of the paint") {
  const sphere_shots shots;
  const auto run = gonio_tool("sphere " + shots.at("paint.hdr") + " " + shots.at("setup.txt") + " --white " +
                              shots.at("white.hdr") + " -o " + shots.at("samples.csv"));
  REQUIRE_MESSAGE(run.exit_code == 0, run.output);
  CHECK(run.output.find("outline matched to") != std::string::npos);
  std::vector<double> off;
  for (const gonio::sample& s : gonio::io::read_samples(shots.at("samples.csv"))) {
    const auto [wi, wo] = s.directions.pair();
    off.push_back(std::abs(s.value.x() / shots.paint(wi, wo).x() - 1.0));
  }
  REQUIRE(off.size() > 500);
  std::ranges::nth_element(off, off.begin() + std::ssize(off) / 2);
  CHECK(off[off.size() / 2] < 0.02);
}

TEST_CASE("a map of normals and one of positions stand for the sphere's outline") {
  const sphere_shots shots;
  const auto setup = gonio::io::read_sphere_setup(shots.at("setup.txt"));
  const gonio::surface_image surface =
      gonio::capture::surface_of(gonio::capture::placed_sphere{{0.02, -0.03, 0.0}, 1.0}, setup.camera);
  const auto put_map = [&](const std::string& name, const Eigen::Matrix3Xd& vectors, std::size_t rows) {
    gonio::capture::vector_map map({rows, vectors.cols() / rows, 3});
    for (Eigen::Index i = 0; i < vectors.size(); ++i) map.data()[i] = static_cast<float>(vectors.data()[i]);
    gonio::io::write_npy(shots.at(name), map);
  };
  put_map("normals.npy", 3.0 * surface.normals, 128);
  put_map("positions.npy", surface.positions, 128);
  scratch::put(shots.at("map.txt"), sphere_scene + "white_reflectance 0.98\n");
  const auto run = [&](const std::string& normals, const std::string& more) {
    return gonio_tool("sphere " + shots.at("paint.hdr") + " " + shots.at("map.txt") + " --white " +
                      shots.at("white.hdr") + " --normals " + shots.at(normals) + more + " -o " + shots.at("map.csv"));
  };
  const std::string positions = " --positions " + shots.at("positions.npy");
  const auto mapped = run("normals.npy", positions);
  REQUIRE_MESSAGE(mapped.exit_code == 0, mapped.output);
  std::vector<double> off;
  for (const gonio::sample& s : gonio::io::read_samples(shots.at("map.csv"))) {
    const auto [wi, wo] = s.directions.pair();
    off.push_back(std::abs(s.value.x() / shots.paint(wi, wo).x() - 1.0));
  }
  REQUIRE(off.size() > 500);
  std::ranges::nth_element(off, off.begin() + std::ssize(off) / 2);
  CHECK(off[off.size() / 2] < 0.02);

  const auto refused = [&](const std::string& normals, const std::string& more, const std::string& why) {
    const auto result = run(normals, more);
    CAPTURE(result.output);
    CHECK(result.exit_code == 2);
    CHECK(result.output.find(why) != std::string::npos);
  };
  refused("normals.npy", "", "needs the positions of the surface");
  put_map("small.npy", surface.normals.leftCols(64), 8);
  refused("small.npy", positions, "small.npy: has 8 x 8 pixels, but its camera 128 x 128");
  put_map("none.npy", 0.0 * surface.normals, 128);
  refused("none.npy", positions, "none.npy: all normals are zero");
  Eigen::Matrix3Xd broken = surface.normals;
  broken(1, 130) = std::numeric_limits<double>::quiet_NaN();
  put_map("broken.npy", broken, 128);
  refused("broken.npy", positions, "pixel (row 1, column 2) is not finite");
}

TEST_CASE("sphere refuses what is missing") {
  const sphere_shots shots;
  const auto refused = [&](const std::string& arguments, const std::string& why) {
    const auto run = gonio_tool("sphere " + arguments + " -o " + shots.at("none.csv"));
    CAPTURE(run.output);
    CHECK(run.exit_code == 2);
    CHECK(run.output.find(why) != std::string::npos);
  };
  const std::string paint = shots.at("paint.hdr") + " ", white = " --white " + shots.at("white.hdr");
  refused(paint + shots.at("setup.txt"), "'white_reflectance' needs --white");
  refused(paint + shots.at("bare.txt"), "bare.txt: needs 'sphere' or the option --normals");
  refused(paint + shots.at("setup.txt") + white + white, "--white needs an image for each photograph: 1, not 2");
  refused(shots.at("paint.hdr") + " " + shots.at("setup.txt") + " --white " + shots.at("black.hdr"),
          "no sphere is found");
  refused(paint + shots.at("setup.txt") + white + " --positions " + shots.at("bare.txt"),
          "--positions needs --normals");
}
