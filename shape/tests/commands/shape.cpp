/// gonio shape: the missing parts of partial scans.

#include "cli/tool.hpp"
#include "io/scratch.hpp"
#include "json.hpp"
#include <gonio/shape/io/mesh.hpp>
#include <gonio/shape/io/pose.hpp>
#include <gonio/shape/io/shape_model.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace io = gonio::io;

namespace {

std::string run_shape(const std::string& arguments) {
  const auto result = gonio_tool("shape " + arguments);
  REQUIRE_MESSAGE(result.exit_code == 0, arguments, ": ", result.output);
  return result.output;
}

/// Checks that bad input gives this message and exit code 2.
void refuses_shape(const std::string& arguments, const std::string& words) {
  const auto result = gonio_tool("shape " + arguments);
  CAPTURE(arguments);
  CAPTURE(result.output);
  CHECK(result.exit_code == 2);
  CHECK(result.output.find(words) != std::string::npos);
}

/// The files and output of `gonio shape demo`, made once because it is slow.
struct shape_demonstration {
  shape_demonstration() : report(run_shape("demo --shapes 40 --held-out 1 --json -o " + at("ears"))) {}

  [[nodiscard]] std::string at(const std::string& name) const { return (folder / name).string(); }
  [[nodiscard]] std::string ear(const std::string& name) const { return at("ears/" + name); }

  scratch::folder folder;
  std::string report;
};

const shape_demonstration& demonstrated() {
  static const shape_demonstration made;
  return made;
}

/// Returns the number after a word in the output.
double number_behind(const std::string& text, const std::string& word) {
  const std::size_t position = text.find(word);
  REQUIRE_MESSAGE(position != std::string::npos, word, " is not in: ", text);
  return std::stod(text.substr(position + word.size()));
}

/// Returns a mesh without the triangles near one of its vertices.
gonio::shape::triangle_mesh with_hole(const gonio::shape::triangle_mesh& mesh, Eigen::Index vertex, double radius) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Eigen::Matrix3d corners = mesh.corners(t).colwise() - mesh.vertices.col(vertex);
    if (corners.colwise().norm().minCoeff() > radius) kept.push_back(t);
  }
  return {mesh.vertices, mesh.triangles(Eigen::all, kept)};
}

}  // namespace

TEST_CASE("shape demo: the model of ears fills a hole better than a smooth surface") {
  const auto& made = demonstrated();
  const auto report = read_json(made.report);
  CHECK(report["shapes"] == 40);
  REQUIRE(report["held_out"].size() == 1);
  const auto& ways = report["held_out"][0];
  CHECK(ways.size() == 5);
  CHECK(ways["missing"] > 20);
  for (const std::string way : {"thin plate", "Algorithm 1", "+ local smoothing", "gonio"}) {
    CAPTURE(way);
    REQUIRE(ways.contains(way));
    const double absolute = ways[way]["absolute_mean"], largest = ways[way]["largest"],
                 signed_mean = ways[way]["signed_mean"];
    CHECK(absolute > 0.0);
    CHECK(absolute < 1.0);
    CHECK(std::abs(signed_mean) <= absolute);
    CHECK(absolute <= largest);
  }
  CHECK(ways["gonio"]["absolute_mean"].get<double>() < ways["thin plate"]["absolute_mean"].get<double>());

  CHECK(scratch::get(made.ear("recovered.png")).starts_with("\x89PNG"));
  const gonio::shape::shape_model model = io::read_shape_model(made.ear("ears.shapes"));
  CHECK(model.shapes() == 40);
  CHECK(model.vertices() == report["vertices"]);
  CHECK(io::read_mesh(made.ear("recovered.ply")).triangles == model.triangles());
  CHECK(io::read_mesh(made.ear("scan.ply")).triangles.cols() < io::read_mesh(made.ear("truth.ply")).triangles.cols());
}

TEST_CASE("shape recover: the scan of the demo, beside the truth") {
  const auto& made = demonstrated();
  const std::string told =
      run_shape("recover " + made.ear("scan.ply") + " --model " + made.ear("ears.shapes") + " --truth " +
                made.ear("truth.ply") + " --image " + made.at("seen.png") + " -o " + made.at("found.ply"));
  const auto vertices = io::read_shape_model(made.ear("ears.shapes")).vertices();
  CHECK(told.find(" of " + std::to_string(vertices) + " vertices are recovered\n") != std::string::npos);
  const double recovered = std::stod(told);
  CHECK(recovered > 100.0);
  CHECK(recovered < 1000.0);
  const double absolute = number_behind(told, "absolute ");
  CHECK(absolute > 0.0);
  CHECK(absolute < 0.3);
  CHECK(std::abs(number_behind(told, "signed mean ")) <= absolute);
  CHECK(number_behind(told, "largest ") >= absolute);
  CHECK(scratch::get(made.at("seen.png")).starts_with("\x89PNG"));
  // The colours show the distance from the truth.
  CHECK(scratch::get(made.at("found.ply")).find("property uchar red") != std::string::npos);
  // The same pose and surface as the demo's, in the scan's space.
  const auto found = io::read_mesh(made.at("found.ply")), shown = io::read_mesh(made.ear("recovered.ply"));
  REQUIRE(found.triangles == shown.triangles);
  CHECK((found.vertices - shown.vertices).cwiseAbs().maxCoeff() < 1e-3);
}

TEST_CASE("shape recover: from a pose in a file, which may be held") {
  const auto& made = demonstrated();
  const std::string files = "recover " + made.ear("scan.ply") + " --model " + made.ear("ears.shapes");
  run_shape(files + " --found-pose " + made.at("pose.txt") + " -o " + made.at("first.ply"));
  const auto first = io::read_mesh(made.at("first.ply"));
  const auto off_by = [&](const std::string& options) {
    run_shape(files + options + " -o " + made.at("again.ply"));
    return (io::read_mesh(made.at("again.ply")).vertices - first.vertices).cwiseAbs().maxCoeff();
  };
  // A fit that starts from the result of another stays there, within its tolerance.
  CHECK(off_by(" --pose " + made.at("pose.txt")) < 0.1);
  CHECK(off_by(" --pose " + made.at("pose.txt") + " --hold-pose") < 0.1);
  const auto pose = io::read_pose(made.at("pose.txt"));
  io::write_pose(made.at("off.txt"), gonio::shape::similarity_transform{.translation = {0.5, 0.0, 0.5}} * pose);
  CHECK(off_by(" --pose " + made.at("off.txt")) < 0.1);
  CHECK(off_by(" --pose " + made.at("off.txt") + " --hold-pose") > 0.1);
  run_shape(files + " --pose " + made.at("off.txt") + " --hold-pose --found-pose " + made.at("held.txt") + " -o " +
            made.at("again.ply"));
  const auto held = io::read_pose(made.at("held.txt")), off = io::read_pose(made.at("off.txt"));
  CHECK((held.rotation - off.rotation).norm() < 1e-12);
  CHECK(held.translation == off.translation);

  const std::string never = " -o " + made.at("never.ply");
  scratch::put(made.at("scaled.txt"), std::string("1.1 0 0 0\n0 1.1 0 0\n0 0 1.1 0\n0 0 0 1\n"));
  refuses_shape(files + " --pose " + made.at("scaled.txt") + never, "scaled.txt: is not a rigid motion");
  scratch::put(made.at("far.txt"), std::string("1 0 0 900\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"));
  refuses_shape(files + " --pose " + made.at("far.txt") + never, "is its pose right?");
  refuses_shape(files + " --hold-pose" + never, "--pose");
  refuses_shape(files + " --pose " + made.at("pose.txt") + " --hold-pose --trials 12" + never, "--hold-pose");
  CHECK_FALSE(std::filesystem::exists(made.at("never.ply")));
}

TEST_CASE("shape learn: a model of meshes in correspondence, and its recovery of a hole") {
  const auto& made = demonstrated();
  const gonio::shape::shape_model model = io::read_shape_model(made.ear("ears.shapes"));
  std::string files;
  gonio::shape::triangle_mesh whole;
  for (Eigen::Index i = 0; i < 12; ++i) {
    whole = model.shape(model.basis().coefficients().row(i).cast<double>());
    files += made.at("ear" + std::to_string(i) + ".ply") + " ";
    io::write_mesh(made.at("ear" + std::to_string(i) + ".ply"), whole);
  }
  const std::string learned = run_shape("learn " + files + "-o " + made.at("dozen.shapes"));
  CHECK(learned.starts_with("12 shapes of " + std::to_string(model.vertices()) + " vertices; "));
  const gonio::shape::shape_model dozen = io::read_shape_model(made.at("dozen.shapes"));
  CHECK(dozen.triangles() == model.triangles());
  REQUIRE(dozen.shapes() == 12);
  CHECK(dozen.basis().names()[10] == "ear10");

  // The model has learned the last ear, so it fills a hole in this ear nearly without error.
  io::write_mesh(made.at("hole.ply"), with_hole(whole, model.vertices() / 2, 3.0));
  const std::string told = run_shape("recover " + made.at("hole.ply") + " --model " + made.at("dozen.shapes") +
                                     " --truth " + made.at("ear11.ply") + " -o " + made.at("filled.ply"));
  CHECK(std::stod(told) > 10.0);
  CHECK(number_behind(told, "absolute ") < 0.1);
  CHECK(io::read_mesh(made.at("filled.ply")).triangles == model.triangles());
}

TEST_CASE("shape recover: how sure the recovered vertices are, from shapes that are left out") {
  const auto& made = demonstrated();
  const std::string told = run_shape("recover " + made.ear("scan.ply") + " --model " + made.ear("ears.shapes") +
                                     " --trials 12 -o " + made.at("sure.ply"));
  const double across = number_behind(told, " left out): "), all = number_behind(told, "across the surface, ");
  CHECK(across > 0.02);
  CHECK(across < 0.5);
  CHECK(all > across);
  CHECK(all < 2.0);
  refuses_shape("recover " + made.ear("scan.ply") + " --model " + made.ear("ears.shapes") + " --trials 41 -o " +
                    made.at("never.ply"),
                "from 10 to 40 shapes can be left out, not 41");
  CHECK_FALSE(std::filesystem::exists(made.at("never.ply")));
}

TEST_CASE("shape grow: a growing model accepts good scans and refuses defective ones") {
  const auto report = read_json(run_shape("grow --scans 6 --defects 0.3 --json"));
  CHECK(report["good"].get<int>() + report["defective"].get<int>() == 6);
  CHECK(report["defective"] >= 1);
  CHECK(report["accepted_good"] >= 1);
  CHECK(report["accepted_defective"] == 0);
  CHECK(report["refusals_of_defective"].size() == report["defective"]);
  CHECK(report["accepted_good"].get<std::size_t>() + report["refusals_of_good"].size() == report["good"]);
  CHECK(report["median_off"] > 0.0);
  CHECK(report["largest_off"] < 2.5);
  CHECK(report["too_far"] == 0);
}

TEST_CASE("shape recover: files without a scan or a model are refused by name") {
  const auto& made = demonstrated();
  const auto refuses_to_recover = [&](const std::string& scan, const std::string& model, const std::string& words) {
    const std::string out = made.at("never.ply");
    refuses_shape("recover " + scan + " --model " + model + " -o " + out, words);
    CHECK_FALSE(std::filesystem::exists(out));
  };
  const std::string model = made.ear("ears.shapes"), scan = made.ear("scan.ply");
  scratch::put(made.at("edge.obj"),
               std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\n"));
  refuses_to_recover(made.at("edge.obj"), model, "edge.obj: a mesh is not a surface: two triangles run from vertex 0");
  scratch::put(made.at("empty.ply"), std::string());
  refuses_to_recover(made.at("empty.ply"), model, "empty.ply: is empty");
  scratch::put(made.at("none.ply"), std::string("ply\nformat ascii 1.0\nelement vertex 0\nproperty double x\n"
                                                "property double y\nproperty double z\nelement face 0\n"
                                                "property list uchar int vertex_indices\nend_header\n"));
  refuses_to_recover(made.at("none.ply"), model, "none.ply: a mesh of 0 vertices has no triangles");
  refuses_to_recover(made.at("missing.ply"), model, "missing.ply: cannot be read");
  refuses_to_recover(scan, scan, "scan.ply: not a gonio shape model");
  refuses_to_recover(scan, made.at("missing.shapes"), "missing.shapes: cannot be read");
  const std::string whole = scratch::get(model);
  scratch::put(made.at("half.shapes"), whole.substr(0, whole.size() / 2));
  refuses_to_recover(scan, made.at("half.shapes"), "half.shapes: the compressed data is truncated");

  gonio::shape::triangle_mesh stretched = io::read_mesh(scan);
  stretched.vertices.row(1) *= 4.0;
  io::write_mesh(made.at("stretched.ply"), stretched);
  refuses_to_recover(made.at("stretched.ply"), model, "stretched.ply: the scan does not match the model");
}

TEST_CASE("shape learn: shapes that do not correspond, or do not differ, are refused") {
  const auto& made = demonstrated();
  const std::string out = made.at("never.shapes"), shape = made.ear("recovered.ply");
  const auto refuses_to_learn = [&](const std::string& files, const std::string& words) {
    refuses_shape("learn " + files + " -o " + out, words);
    CHECK_FALSE(std::filesystem::exists(out));
  };
  refuses_to_learn(shape + " " + made.ear("truth.ply"), "truth.ply: does not have the vertices and triangles of");
  gonio::shape::triangle_mesh turned = io::read_mesh(shape);
  turned.triangles.row(0).swap(turned.triangles.row(1));
  io::write_mesh(made.at("turned.ply"), turned);
  refuses_to_learn(shape + " " + made.at("turned.ply"), "turned.ply: does not have the vertices and triangles of");
  refuses_to_learn(shape, "a shape model needs at least two different shapes, not 1 equal ones");
  refuses_to_learn(made.at("missing.ply"), "missing.ply: cannot be read");
}

TEST_CASE("shape: options out of range are refused") {
  refuses_shape("", "subcommand");
  refuses_shape("recover scan.ply -o x.ply", "--model");
  refuses_shape("recover scan.ply --model x.shapes --noise 0 -o x.ply", "--noise");
  refuses_shape("recover scan.ply --model x.shapes -o ./scan.ply", "would overwrite the input scan");
  refuses_shape("recover scan.ply --model x.shapes --truth y.ply -o y.ply", "would overwrite the input --truth");
  refuses_shape("recover scan.ply --model x.shapes -o x.stl", "expected a name that ends in .ply or .obj");
  refuses_shape("learn x.shapes --scans y.ply -o x.shapes", "would overwrite the input shapes");
  refuses_shape("demo --shapes 2", "--shapes");
  refuses_shape("demo --hole none", "--hole");
  refuses_shape("grow --annotated 1", "--annotated");
  refuses_shape("grow --defects 1.5", "--defects");
}
