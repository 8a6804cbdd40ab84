#include "synthetic_canals.hpp"
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/shape/shape_context.hpp>

#include <Eigen/Geometry>
#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <functional>
#include <iostream>  // rapidcheck.h does not include what it uses
#include <limits>
#include <set>

using gonio::shape::describe;
using gonio::shape::shape_context_options;
using gonio::shape::spread_vertices;
using gonio::shape::triangle_mesh;

namespace {

/// Returns a rotation about the vertical axis.
Eigen::Matrix3d turned_about_y(double degrees) {
  return Eigen::AngleAxisd(gonio::radians(degrees), Eigen::Vector3d::UnitY()).toRotationMatrix();
}

double chi_square_between(const Eigen::VectorXf& a, const Eigen::VectorXf& b) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    const double x = static_cast<double>(a[i]), y = static_cast<double>(b[i]);
    if (x + y > 0.0) sum += 0.5 * (x - y) * (x - y) / (x + y);
  }
  return sum;
}

gonio::shape::shape_descriptors with_histograms(const Eigen::MatrixXf& histograms) {
  return {std::vector<Eigen::Index>(histograms.cols(), 0), histograms};
}

}  // namespace

TEST_CASE("a frame is right-handed, with the normal third and the vertical in the plane of the first and third") {
  CHECK(rc::check([] {
    std::mt19937_64 generator(*rc::gen::arbitrary<std::uint64_t>());
    shape_context_options options;
    options.vertical = synthetic_point(generator, 5.0);
    const Eigen::Vector3d normal = synthetic_point(generator, 1.0).normalized();
    const double inclination = gonio::angle_between(normal, options.vertical);
    const bool expected = std::min(inclination, std::numbers::pi - inclination) > options.least_inclination;
    const auto frame = gonio::shape::context_frame(normal, options);
    RC_ASSERT(frame.has_value() == expected);
    if (!frame) return;
    RC_ASSERT((frame->transpose() * *frame - Eigen::Matrix3d::Identity()).norm() < 1e-12);
    RC_ASSERT(std::abs(frame->determinant() - 1.0) < 1e-12);
    RC_ASSERT((frame->col(2) - normal).norm() < 1e-12);
    RC_ASSERT(frame->col(0).dot(options.vertical) > 0.0);
    RC_ASSERT(std::abs(frame->col(1).dot(options.vertical)) < 1e-12);
  }));
  CHECK_FALSE(gonio::shape::context_frame(Eigen::Vector3d::Zero(), {}).has_value());
}

TEST_CASE("the bins of points around a point") {
  const shape_context_options options;  // 8 x 13 x 4 within 10
  const auto bin = [&](double r, double theta, double phi) {
    const double across = r * std::sin(gonio::radians(theta));
    return gonio::shape::context_bin({across * std::cos(gonio::radians(phi)), across * std::sin(gonio::radians(phi)),
                                      r * std::cos(gonio::radians(theta))},
                                     options);
  };
  CHECK(options.bins() == 416);
  CHECK(bin(0.1, 1.0, -135.0) == 0);
  CHECK(bin(0.1, 1.0, -45.0) == 1);
  CHECK(bin(0.1, 1.0, 45.0) == 2);
  CHECK(bin(0.1, 1.0, 135.0) == 3);  // arctan(y / x) would give the bin of -45
  CHECK(bin(0.1, 90.0, 45.0) == 6 * 4 + 2);
  CHECK(bin(0.1, 179.0, 45.0) == 12 * 4 + 2);
  CHECK(bin(1.3, 1.0, 45.0) == 52 + 2);
  CHECK(bin(10.0, 179.9, 179.9) == 415);  // the last bin includes its upper end
  CHECK(gonio::shape::context_bin({0.0, 0.0, 10.0}, options) == 7 * 52 + 2);
  CHECK(gonio::shape::context_bin({0.0, 0.0, -10.0}, options) == 7 * 52 + 12 * 4 + 2);
}

TEST_CASE("a descriptor agrees with areas computed by hand") {
  // Equilateral triangles with side 1 in the plane z = 0. The neighbours within 1.2 of an inner vertex are its six
  // neighbours, which also have six triangles each.
  const triangle_mesh grid = flat_grid(7, 9, 1.0, std::sqrt(0.75), -0.5);
  shape_context_options options;
  options.radius = 1.2;
  options.radial_bins = 2;
  const Eigen::Index middle = 3 * 9 + 5;
  const auto found = describe(grid, {middle}, options);
  REQUIRE(found.vertex == std::vector<Eigen::Index>{middle});
  REQUIRE(found.histograms.rows() == options.bins());
  // b1 is y and b2 is b3 x b1 = -x. The azimuths of the neighbours from y are 30, 90, 150, -150, -90 and -30 degrees.
  // The azimuths +-90 are at a border of bins, and rounding puts them on either side.
  const auto sector = [&](Eigen::Index azimuthal) { return found.histograms((13 + 6) * 4 + azimuthal, 0); };
  CHECK(sector(0) + sector(1) + sector(2) + sector(3) == doctest::Approx(1.0));
  for (Eigen::Index i = 0; i < 4; ++i) CHECK(std::round(6.0F * sector(i)) >= 1.0F);
  for (Eigen::Index i = 0; i < 4; ++i) CHECK(std::abs(6.0F * sector(i) - std::round(6.0F * sector(i))) < 1e-4F);
}

TEST_CASE("a descriptor is left unchanged by turns about the vertical, translations and the number of threads") {
  const triangle_mesh canal = canal_mesh(30, 26);
  const auto chosen = spread_vertices(canal, 40);
  const auto expected = describe(canal, chosen, {}, {1});
  CHECK(expected.vertex.size() > 30);
  for (Eigen::Index i = 0; i < expected.histograms.cols(); ++i)
    CHECK(expected.histograms.col(i).sum() == doctest::Approx(1.0));
  CHECK(describe(canal, chosen, {}, {3}).histograms == expected.histograms);
  triangle_mesh posed = canal;
  posed.vertices = (turned_about_y(133.0) * canal.vertices).colwise() + Eigen::Vector3d(30.0, -200.0, 7.0);
  const auto found = describe(posed, chosen);
  REQUIRE(found.vertex == expected.vertex);
  // Equal, except for vertices at a border of bins.
  for (Eigen::Index i = 0; i < found.histograms.cols(); ++i)
    CHECK(chi_square_between(found.histograms.col(i), expected.histograms.col(i)) < 0.01);
  // A rotation about another axis changes it.
  posed.vertices = Eigen::AngleAxisd(gonio::radians(60), Eigen::Vector3d::UnitX()).toRotationMatrix() * canal.vertices;
  const auto tilted = describe(posed, {expected.vertex[5]});
  REQUIRE(tilted.vertex.size() == 1);
  CHECK(chi_square_between(tilted.histograms.col(0), expected.histograms.col(5)) > 0.1);
}

TEST_CASE("a descriptor depends on the surface, not on its triangulation") {
  // One part of a plane has twice the vertex density of the other along x.
  const auto plane_of = [](int columns, bool uneven) {
    triangle_mesh plane = flat_grid(41, columns, 40.0 / (columns - 1), 1.0);
    for (double& x : plane.vertices.row(0))
      if (uneven) x = x + 4.0 * std::sin(std::numbers::pi * x / 20.0);
    return plane;
  };
  const triangle_mesh even = plane_of(161, false), uneven = plane_of(161, true);
  const Eigen::Index middle = 20 * 161 + 80;
  shape_context_options coarse;
  coarse.radial_bins = 4;
  const auto first = describe(even, {middle}, coarse), second = describe(uneven, {middle}, coarse);
  CHECK(chi_square_between(first.histograms.col(0), second.histograms.col(0)) < 0.01);
}

TEST_CASE("points without a frame or without surroundings are skipped, others keep their order") {
  const triangle_mesh sphere = sphere_mesh(3, 5.0);
  std::vector<Eigen::Index> all(sphere.vertices.cols());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  const auto found = describe(sphere, all);
  std::vector<Eigen::Index> expected;
  const gonio::shape::point_columns normals = gonio::shape::vertex_normals(sphere);
  for (const Eigen::Index v : all)
    if (std::abs(normals(1, v)) <= std::cos(gonio::radians(10))) expected.push_back(v);
  CHECK(found.vertex == expected);
  CHECK(expected.size() < all.size());
  CHECK(found.histograms.cols() == std::ssize(expected));
  shape_context_options near;
  near.radius = 1e-3;
  CHECK(describe(sphere, all, near).vertex.empty());
  // A stray vertex has no area and no normal.
  triangle_mesh strayed = sphere;
  strayed.vertices.conservativeResize(3, sphere.vertices.cols() + 1);
  strayed.vertices.rightCols<1>() << 1.0, 0.0, 0.0;
  CHECK(describe(strayed, all).histograms == found.histograms);
  CHECK(describe(strayed, {sphere.vertices.cols()}).vertex.empty());
}

TEST_CASE("each spread vertex is the farthest from the vertices before it") {
  const triangle_mesh canal = canal_mesh(20, 17);
  const auto chosen = spread_vertices(canal, 60);
  REQUIRE(chosen.size() == 60);
  CHECK(std::set<Eigen::Index>(chosen.begin(), chosen.end()).size() == 60);
  CHECK(spread_vertices(canal, 10) == std::vector<Eigen::Index>(chosen.begin(), chosen.begin() + 10));
  const Eigen::Vector3d centroid = canal.vertices.rowwise().mean();
  Eigen::Index first = 0;
  (canal.vertices.colwise() - centroid).colwise().norm().maxCoeff(&first);
  CHECK(chosen[0] == first);
  const gonio::shape::point_columns positions = canal.vertices(Eigen::all, chosen);
  for (Eigen::Index i = 1; i < 60; ++i) {
    const auto nearest = [&](const Eigen::Vector3d& point) {
      return (positions.leftCols(i).colwise() - point).colwise().norm().minCoeff();
    };
    const double own = nearest(positions.col(i));
    for (Eigen::Index v = 0; v < canal.vertices.cols(); ++v) REQUIRE(nearest(canal.vertices.col(v)) <= own + 1e-12);
  }
}

TEST_CASE("spread vertices belong to triangles and have different positions") {
  triangle_mesh mesh = tetrahedron();
  mesh.vertices.conservativeResize(3, 6);
  mesh.vertices.rightCols<2>() << 100.0, 0.0, 0.0, 0.0, 0.0, 0.0;  // two unused vertices
  const auto chosen = spread_vertices(mesh, 10);
  CHECK(std::set<Eigen::Index>(chosen.begin(), chosen.end()) == std::set<Eigen::Index>{0, 1, 2, 3});
  CHECK(chosen.size() == 4);
  CHECK(spread_vertices(mesh, 0).empty());
  mesh.vertices.col(3) = mesh.vertices.col(2);
  CHECK(spread_vertices(mesh, 10).size() == 3);
}

TEST_CASE("costs are chi-square distances") {
  Eigen::MatrixXf a(3, 2), b(3, 3);
  a << 1.0F, 0.5F, 0.0F, 0.5F, 0.0F, 0.0F;
  b << 1.0F, 0.0F, 0.5F, 0.0F, 0.0F, 0.25F, 0.0F, 1.0F, 0.25F;
  const Eigen::MatrixXd costs = gonio::shape::chi_square_costs(with_histograms(a), with_histograms(b));
  REQUIRE(costs.rows() == 2);
  REQUIRE(costs.cols() == 3);
  CHECK(costs(0, 0) == 0.0);
  CHECK(costs(0, 1) == doctest::Approx(1.0));
  CHECK(costs(1, 0) == doctest::Approx(0.5 * (0.25 / 1.5 + 0.5)));
  CHECK(costs(1, 2) == doctest::Approx(0.5 * (0.0625 / 0.75 + 0.25)));
  const triangle_mesh canal = canal_mesh(20, 17), other = canal_mesh(22, 16, synthetic_traits(3));
  const auto first = describe(canal, spread_vertices(canal, 30)), second = describe(other, spread_vertices(other, 35));
  const Eigen::MatrixXd all = gonio::shape::chi_square_costs(first, second, {1});
  CHECK(gonio::shape::chi_square_costs(first, second, {4}) == all);
  for (Eigen::Index i = 0; i < all.rows(); ++i)
    for (Eigen::Index j = 0; j < all.cols(); ++j)
      CHECK(all(i, j) ==
            doctest::Approx(chi_square_between(first.histograms.col(i), second.histograms.col(j))).epsilon(1e-5));
  CHECK_THROWS_WITH_AS((void)gonio::shape::chi_square_costs(with_histograms(a), first),
                       "descriptors of 3 and 416 bins cannot be compared", gonio::error);
}

TEST_CASE("a surface is matched to itself, whichever has more points") {
  const triangle_mesh canal = canal_mesh(30, 26);
  const auto few = describe(canal, spread_vertices(canal, 40)), many = describe(canal, spread_vertices(canal, 60));
  for (const auto& [from, onto] : {std::pair(&few, &many), std::pair(&many, &few), std::pair(&few, &few)}) {
    const auto matches = gonio::shape::match(*from, *onto);
    CHECK(matches.size() == std::min(from->vertex.size(), onto->vertex.size()));
    for (const auto& [own, other, cost] : matches) {
      CHECK(from->vertex[own] == onto->vertex[other]);
      CHECK(cost == 0.0);
    }
  }
  // The matches are sorted by cost.
  const triangle_mesh other = canal_mesh(30, 26, synthetic_traits(4));
  const auto matches = gonio::shape::match(describe(other, spread_vertices(other, 50)), many);
  CHECK(std::ranges::is_sorted(matches, {}, &gonio::shape::shape_match::cost));
  CHECK(matches.front().cost > 0.0);
}

TEST_CASE("meshes and options that cannot be used are refused") {
  const triangle_mesh canal = canal_mesh(10, 9);
  const auto refused = [&](const std::function<void(shape_context_options&)>& change, const char* why) {
    shape_context_options options;
    change(options);
    CHECK_THROWS_WITH_AS((void)describe(canal, {3}, options), doctest::Contains(why), gonio::error);
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  refused([](auto& o) { o.radial_bins = 0; }, "at least one bin");
  refused([](auto& o) { o.polar_bins = -1; }, "at least one bin");
  refused([](auto& o) { o.azimuthal_bins = 0; }, "at least one bin");
  refused([](auto& o) { o.radius = 0.0; }, "radius");
  refused([](auto& o) { o.radius = std::numeric_limits<double>::infinity(); }, "radius");
  refused([](auto& o) { o.vertical.setZero(); }, "vertical axis");
  refused([](auto& o) { o.vertical.x() = nan; }, "vertical axis");
  refused([](auto& o) { o.least_inclination = 0.0; }, "least inclination");
  refused([](auto& o) { o.least_inclination = 1.6; }, "least inclination");
  CHECK_THROWS_WITH_AS((void)describe(canal, {90}), "vertex 90 of a mesh of 90 vertices does not exist", gonio::error);
  CHECK_THROWS_AS((void)describe(canal, {-1}), gonio::error);
  CHECK_THROWS_AS((void)spread_vertices(canal, -1), gonio::error);
  const auto refused_mesh = [](const triangle_mesh& mesh, const char* why) {
    CHECK_THROWS_WITH_AS((void)describe(mesh, {0}), doctest::Contains(why), gonio::error);
    CHECK_THROWS_WITH_AS((void)spread_vertices(mesh, 3), doctest::Contains(why), gonio::error);
  };
  triangle_mesh broken = canal;
  broken.vertices(0, 4) = nan;
  refused_mesh(broken, "finite");
  broken = canal;
  broken.triangles(1, 3) = 90;
  refused_mesh(broken, "names a vertex that does not exist, expected less than 90");
  broken.triangles(1, 3) = -1;
  refused_mesh(broken, "names a vertex");
  refused_mesh({canal.vertices, gonio::shape::triangle_columns(3, 0)}, "no triangles");
}
