#include "synthetic_canals.hpp"
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/shape/shape_context_alignment.hpp>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <limits>

using gonio::shape::pre_alignment;
using gonio::shape::shape_context_alignment_options;
using gonio::shape::shape_context_matcher;
using gonio::shape::similarity_transform;
using gonio::shape::triangle_mesh;

namespace {

/// Returns a pose on the platform: any rotation about the vertical axis, at any position.
similarity_transform platform_pose(std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  const double turn = 2.0 * std::numbers::pi * synthetic_number(generator);
  return {1.0, Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitY()).toRotationMatrix(), synthetic_point(generator, 80.0)};
}

triangle_mesh posed(triangle_mesh mesh, const similarity_transform& pose) {
  mesh.vertices = pose(mesh.vertices);
  return mesh;
}

double turn_between(const similarity_transform& a, const similarity_transform& b) {
  return gonio::degrees(Eigen::AngleAxisd(a.rotation * b.rotation.transpose()).angle());
}

/// Returns a mesh without the triangles near a point.
triangle_mesh with_hole(const triangle_mesh& mesh, const Eigen::Vector3d& centre, double radius) {
  triangle_mesh left{mesh.vertices, gonio::shape::triangle_columns(3, mesh.triangles.cols())};
  Eigen::Index kept = 0;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t)
    if ((mesh.corners(t).rowwise().mean() - centre).norm() > radius) left.triangles.col(kept++) = mesh.triangles.col(t);
  left.triangles.conservativeResize(3, kept);
  return left;
}

/// Returns options with fewer points than the default, to save time.
shape_context_alignment_options quick_options() {
  shape_context_alignment_options options;
  options.points = 120;
  return options;
}

constexpr Eigen::Index canal_rings = 36, canal_sectors = 32;

triangle_mesh individual_canal(std::uint64_t seed) {
  return canal_mesh(canal_rings, canal_sectors, synthetic_traits(seed));
}

}  // namespace

TEST_CASE("a model in another pose is brought back") {
  const triangle_mesh model = canal_mesh(canal_rings, canal_sectors);
  const shape_context_matcher matcher(model, quick_options());
  for (std::uint64_t seed = 1; seed < 4; ++seed) {
    const similarity_transform pose = platform_pose(seed);
    const pre_alignment found = matcher.align(posed(model, pose));
    CHECK((found.transform(pose(model.vertices)) - model.vertices).norm() < 1e-6);
    CHECK(found.mean_distance < 1e-6);
    CHECK(found.mean_scan_distance < 1e-6);
    CHECK(found.matches > 100);
    CHECK(found.transform.scale == 1.0);
  }
}

TEST_CASE("individuals, otherwise triangulated and in any pose, are brought near the model") {
  const triangle_mesh model = canal_mesh(canal_rings, canal_sectors);
  const shape_context_matcher matcher(model, quick_options());
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const similarity_transform pose = platform_pose(seed);
    const triangle_mesh scan = posed(canal_mesh(45, 29, synthetic_traits(seed)), pose);
    const similarity_transform truth = gonio::shape::align(pose(individual_canal(seed).vertices), model.vertices);
    const pre_alignment found = matcher.align(scan);
    CHECK(turn_between(found.transform, truth) < 12.0);
    CHECK((found.transform(scan.vertices) - truth(scan.vertices)).colwise().norm().mean() < 2.5);
    CHECK(found.mean_distance < 2.0);
  }
}

TEST_CASE("the mean distances are those of closest vertices") {
  const triangle_mesh model = canal_mesh(20, 17),
                      scan = posed(canal_mesh(17, 21, synthetic_traits(5)), platform_pose(5));
  const pre_alignment found = gonio::shape::align_by_shape_context(scan, model, quick_options());
  const gonio::shape::point_columns aligned = found.transform(scan.vertices);
  const auto expected = [](const gonio::shape::point_columns& from, const gonio::shape::point_columns& onto) {
    double sum = 0.0;
    for (const auto& point : from.colwise()) sum += (onto.colwise() - point).colwise().norm().minCoeff();
    return sum / static_cast<double>(from.cols());
  };
  CHECK(found.mean_distance == doctest::Approx(expected(model.vertices, aligned)));
  CHECK(found.mean_scan_distance == doctest::Approx(expected(aligned, model.vertices)));
  // Unused vertices do not count.
  triangle_mesh strayed = scan;
  strayed.vertices.conservativeResize(3, scan.vertices.cols() + 1);
  strayed.vertices.rightCols<1>() = found.transform.inverse()(model.vertices.col(7));
  CHECK(gonio::shape::align_by_shape_context(strayed, model, quick_options()).mean_distance ==
        doctest::Approx(found.mean_distance));
}

TEST_CASE("a large hole matters little, and less than to plain least squares") {
  const triangle_mesh model = canal_mesh(canal_rings, canal_sectors);
  shape_context_alignment_options plain = quick_options();
  plain.tolerance = std::numeric_limits<double>::infinity();
  plain.significant = 1.0;
  const shape_context_matcher robust_matcher(model, quick_options()), plain_matcher(model, plain);
  double robust_error = 0.0, plain_error = 0.0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const triangle_mesh whole = individual_canal(seed);
    const similarity_transform pose = platform_pose(seed),
                               truth = gonio::shape::align(pose(whole.vertices), model.vertices);
    const Eigen::Index at = seed * 137;
    const triangle_mesh scan = posed(with_hole(whole, whole.vertices.col(at), 8.0), pose);
    const pre_alignment found = robust_matcher.align(scan);
    CHECK(turn_between(found.transform, truth) < 25.0);
    CHECK(found.mean_scan_distance < found.mean_distance);
    robust_error += turn_between(found.transform, truth) / 6.0;
    plain_error += turn_between(plain_matcher.align(scan).transform, truth) / 6.0;
  }
  CAPTURE(robust_error);
  CAPTURE(plain_error);
  CHECK(robust_error < plain_error);
}

TEST_CASE("an infinite tolerance is the paper's least squares over the most significant matches") {
  const triangle_mesh model = canal_mesh(canal_rings, canal_sectors), scan = individual_canal(9);
  shape_context_alignment_options options = quick_options();
  options.tolerance = std::numeric_limits<double>::infinity();
  const auto from = gonio::shape::describe(scan, gonio::shape::spread_vertices(scan, 120)),
             onto = gonio::shape::describe(model, gonio::shape::spread_vertices(model, 120));
  const auto matches = gonio::shape::match(from, onto);
  const std::size_t count = std::lround(static_cast<double>(matches.size()) / 3.0);
  std::vector<Eigen::Index> ours, theirs;
  for (std::size_t i = 0; i < count; ++i) {
    ours.push_back(from.vertex[matches[i].from]);
    theirs.push_back(onto.vertex[matches[i].onto]);
  }
  const similarity_transform expected =
      gonio::shape::align(scan.vertices(Eigen::all, ours), model.vertices(Eigen::all, theirs));
  const pre_alignment found = gonio::shape::align_by_shape_context(scan, model, options);
  CHECK(found.matches == count);
  CHECK((found.transform(scan.vertices) - expected(scan.vertices)).norm() < 1e-9);
}

TEST_CASE("wrong matches do not move the pose, if there are not too many") {
  std::mt19937_64 generator(4);
  gonio::shape::detail::matched_points points{gonio::shape::point_columns(3, 90), {}};
  for (auto point : points.from.colwise()) point = synthetic_point(generator, 12.0);
  const similarity_transform pose = platform_pose(3);
  points.onto = pose(points.from);
  for (Eigen::Index i = 1; i < 90; i += 3) points.onto.col(i) = pose(synthetic_point(generator, 12.0));
  const auto [found, used] = gonio::shape::detail::robust_pose(points, 30, 3.0);
  CHECK(turn_between(found, pose) < 1.5);
  CHECK(used >= 60);
  CHECK(used < 66);
  CHECK(turn_between(gonio::shape::detail::robust_pose(points, 30, std::numeric_limits<double>::infinity()).first,
                     pose) > 3.0);
}

TEST_CASE("the same bytes for any number of threads") {
  const triangle_mesh model = canal_mesh(20, 17),
                      scan = posed(canal_mesh(25, 20, synthetic_traits(2)), platform_pose(2));
  const auto run = [&](unsigned threads) {
    return gonio::shape::align_by_shape_context(scan, model, quick_options(), {threads});
  };
  const pre_alignment one = run(1), three = run(3);
  CHECK(one.transform.rotation == three.transform.rotation);
  CHECK(one.transform.translation == three.transform.translation);
  CHECK(one.mean_distance == three.mean_distance);
  CHECK(one.mean_scan_distance == three.mean_scan_distance);
  CHECK(one.matches == three.matches);
}

TEST_CASE("meshes and options that cannot be used for an alignment are refused") {
  const triangle_mesh model = canal_mesh(10, 9);
  const auto refused = [&](const std::function<void(shape_context_alignment_options&)>& change, const char* why) {
    shape_context_alignment_options options;
    change(options);
    CHECK_THROWS_WITH_AS(shape_context_matcher(model, options), doctest::Contains(why), gonio::error);
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  refused([](auto& o) { o.points = 2; }, "at least three points, not 2");
  refused([](auto& o) { o.significant = 0.0; }, "significant");
  refused([](auto& o) { o.significant = 1.01; }, "significant");
  refused([](auto& o) { o.tolerance = nan; }, "tolerance");
  refused([](auto& o) { o.context.radius = -1.0; }, "radius");
  // A flat mesh on the platform.
  triangle_mesh flat = flat_grid(8, 8);
  flat.vertices.row(1).swap(flat.vertices.row(2));
  CHECK_THROWS_WITH_AS(shape_context_matcher{flat}, doctest::Contains("a model to be aligned"), gonio::error);
  const shape_context_matcher matcher(model);
  CHECK_THROWS_WITH_AS((void)matcher.align(flat), doctest::Contains("a scan to be aligned by shape contexts has 0"),
                       gonio::error);
  triangle_mesh broken = model;
  broken.vertices(2, 2) = nan;
  CHECK_THROWS_AS((void)matcher.align(broken), gonio::error);
}
