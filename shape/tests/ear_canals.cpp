#include "dense_reference.hpp"
#include <gonio/core/error.hpp>
#include <gonio/shape/mesh_topology.hpp>
#include <gonio/shape/surface_index.hpp>

#include <Eigen/Dense>
#include <doctest/doctest.h>
#include <rapidcheck.h>
#include <synthetic/ear_canal_scans.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <vector>

namespace {

/// Returns options for scans that are quick to make.
synthetic::scan_options quick_ear_scan() {
  synthetic::scan_options options;
  options.vertices = 1500;
  options.complete_vertices = 0;
  return options;
}

const synthetic::ear_canal_template& ear_template() {
  static const synthetic::ear_canal_template common;
  return common;
}

/// Returns the smallest angle of each triangle in degrees, ascending.
std::vector<double> smallest_angles(const gonio::shape::triangle_mesh& mesh) {
  std::vector<double> angles;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Eigen::Matrix3d corners = mesh.corners(t);
    double least = 180.0;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d first = (corners.col((k + 1) % 3) - corners.col(k)).normalized(),
                            second = (corners.col((k + 2) % 3) - corners.col(k)).normalized();
      least = std::min(least, std::acos(first.dot(second)) * 180.0 / std::numbers::pi);
    }
    angles.push_back(least);
  }
  std::ranges::sort(angles);
  return angles;
}

/// Returns V - E + F.
Eigen::Index euler_number(const gonio::shape::triangle_mesh& mesh) {
  std::map<std::pair<int, int>, int> edges;
  for (const auto& corners : mesh.triangles.colwise())
    for (int side = 0; side < 3; ++side) ++edges[std::minmax({corners[side], corners[(side + 1) % 3]})];
  return mesh.vertices.cols() - std::ssize(edges) + mesh.triangles.cols();
}

bool uses_all_vertices(const gonio::shape::triangle_mesh& mesh) {
  std::vector<bool> used(mesh.vertices.cols(), false);
  for (const int vertex : mesh.triangles.reshaped()) used[vertex] = true;
  return std::ranges::find(used, false) == used.end();
}

/// Returns the fraction of triangles whose normals agree with the surface's.
double share_outwards(const synthetic::ear_canal& individual, const gonio::shape::triangle_mesh& mesh,
                      const synthetic::parameter_columns& parameters) {
  const gonio::shape::point_columns normals = gonio::shape::area_normals(mesh);
  double outwards = 0.0;
  for (Eigen::Index t = 0; t < normals.cols(); ++t) {
    const Eigen::Vector2d point = parameters.col(mesh.triangles(0, t));
    if (normals.col(t).dot(individual.normal(point.x(), point.y())) > 0.0) outwards += 1.0;
  }
  return outwards / static_cast<double>(normals.cols());
}

/// Returns whether a side of a triangle intersects another triangle without a common vertex.
bool intersects_itself(const gonio::shape::triangle_mesh& mesh) {
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Eigen::Matrix3d of = mesh.corners(t);
    const Eigen::Vector3d low = of.rowwise().minCoeff(), high = of.rowwise().maxCoeff();
    const Eigen::Vector3d normal = (of.col(1) - of.col(0)).cross(of.col(2) - of.col(0));
    for (const auto& corners : mesh.triangles.colwise())
      for (int side = 0; side < 3; ++side) {
        const int from = corners[side], to = corners[(side + 1) % 3];
        const Eigen::Vector3d a = mesh.vertices.col(from), b = mesh.vertices.col(to);
        if ((a.cwiseMax(b).array() < low.array()).any() || (a.cwiseMin(b).array() > high.array()).any()) continue;
        if ((mesh.triangles.col(t).array() == from).any() || (mesh.triangles.col(t).array() == to).any()) continue;
        const double above = normal.dot(a - of.col(0)), below = normal.dot(b - of.col(0));
        if (above * below >= 0.0) continue;
        const Eigen::Vector3d point = a + above / (above - below) * (b - a);
        bool within = true;
        for (int k = 0; k < 3; ++k)
          within = within && normal.dot((of.col((k + 1) % 3) - of.col(k)).cross(point - of.col(k))) > 0.0;
        if (within) return true;
      }
  }
  return false;
}

template <class Columns>
bool equal_columns(const Columns& first, const Columns& second) {
  return first.cols() == second.cols() && first == second;
}

bool equal_scans(const synthetic::ear_scan& first, const synthetic::ear_scan& second) {
  return equal_columns(first.mesh.vertices, second.mesh.vertices) &&
         equal_columns(first.mesh.triangles, second.mesh.triangles) &&
         equal_columns(first.parameters, second.parameters) && equal_columns(first.truth, second.truth) &&
         first.covered == second.covered && equal_columns(first.complete.vertices, second.complete.vertices) &&
         first.defect == second.defect && first.placement.matrix() == second.placement.matrix();
}

/// Returns the distances of a scan's vertices from their positions on the individual, along the normal.
std::vector<double> offsets_of(const synthetic::ear_scan& scan) {
  const Eigen::Affine3d back = scan.placement.inverse();
  std::vector<double> offsets;
  for (Eigen::Index i = 0; i < scan.parameters.cols(); ++i) {
    const double u = scan.parameters(0, i), v = scan.parameters(1, i);
    offsets.push_back((back * scan.mesh.vertices.col(i) - scan.individual.at(u, v)).dot(scan.individual.normal(u, v)));
  }
  return offsets;
}

double root_mean_square(const std::vector<double>& numbers) {
  double sum = 0.0;
  for (const double number : numbers) sum += number * number;
  return std::sqrt(sum / static_cast<double>(numbers.size()));
}

/// Returns points rotated and translated onto others in the least-squares sense.
gonio::shape::point_columns turned_onto(const gonio::shape::point_columns& points,
                                        const gonio::shape::point_columns& onto) {
  const Eigen::Matrix3d spread = onto * points.transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> parts(spread, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return parts.matrixU() * parts.matrixV().transpose() * points;
}

}  // namespace

TEST_CASE("the template of ear canals has 3096 vertices and near-equilateral triangles") {
  const gonio::shape::triangle_mesh& mesh = ear_template().mesh();
  CHECK(mesh.vertices.cols() == 3096);
  CHECK_NOTHROW(gonio::shape::mesh_topology{mesh});
  CHECK(euler_number(mesh) == 1);  // a disc: open outside, closed at the tip
  CHECK(uses_all_vertices(mesh));
  CHECK(share_outwards(synthetic::ear_canal_family::mean(), mesh, ear_template().parameters()) == 1.0);
  const std::vector<double> angles = smallest_angles(mesh);
  MESSAGE("smallest angles of the template in degrees: least " << angles.front() << ", 20th percentile "
                                                               << angles[angles.size() / 5]);
  CHECK(angles[angles.size() / 5] > 40.0);
  CHECK(angles.front() > 20.0);
  for (const Eigen::Index vertices : {50U, 51U, 52U, 313U, 1000U})
    CHECK(static_cast<Eigen::Index>(synthetic::ear_canal_template(vertices).mesh().vertices.cols()) == vertices);
}

TEST_CASE("ear canals differ by one or two millimetres once they are aligned") {
  const synthetic::ear_canal_template coarse(300);
  constexpr int count = 100;
  std::vector<gonio::shape::point_columns> shapes;
  gonio::shape::point_columns mean = gonio::shape::point_columns::Zero(3, 300);
  int odd = 0;
  for (int seed = 0; seed < count; ++seed) {
    const synthetic::ear_canal individual = synthetic::ear_canal_family().draw(static_cast<std::uint64_t>(seed));
    odd += individual.oddity() ? 1 : 0;
    gonio::shape::point_columns points = coarse.corresponded(individual);
    points.colwise() -= points.rowwise().mean().eval();
    shapes.push_back(shapes.empty() ? points : turned_onto(points, shapes.front()));
    mean += shapes.back() / count;
  }
  Eigen::VectorXd variances = Eigen::VectorXd::Zero(300);
  for (const gonio::shape::point_columns& one : shapes)
    variances += (one - mean).colwise().squaredNorm().transpose() / (count - 1);
  CHECK(std::sqrt(variances.mean()) > 1.0);
  CHECK(std::sqrt(variances.mean()) < 2.0);
  CHECK(std::sqrt(variances.minCoeff()) > 0.4);
  CHECK(std::sqrt(variances.maxCoeff()) < 3.5);
  CHECK(odd <= 10);

  Eigen::MatrixXd changes(900, count);
  for (int i = 0; i < count; ++i) changes.col(i) = (shapes[i] - mean).reshaped();
  const Eigen::VectorXd squares = dense_reference::svd(changes).values.array().square();
  CHECK(squares[0] / squares.sum() < 0.5);  // no single direction explains the family
  CHECK(squares.head(10).sum() / squares.sum() > 0.7);
  CHECK(squares.head(20).sum() / squares.sum() < 0.995);
}

TEST_CASE("an ear canal is regular, inwards, upright and does not intersect itself") {
  const synthetic::ear_canal_template coarse(500);
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const synthetic::ear_canal individual = synthetic::ear_canal_family(1.0, 0.5).draw(seed);
    gonio::shape::triangle_mesh mesh = coarse.mesh();
    mesh.vertices = coarse.corresponded(individual);
    CHECK(individual.regularity() > 0.15);
    CHECK_FALSE(intersects_itself(mesh));
    CHECK(share_outwards(individual, mesh, coarse.parameters()) > 0.99);
    const Eigen::Vector3d inwards = (individual.centre(1.0) - individual.centre(0.0)).normalized();
    CHECK(inwards.x() < -0.75);
    double length = 0.0;
    for (int i = 0; i < 100; ++i) length += (individual.centre(0.01 * (i + 1)) - individual.centre(0.01 * i)).norm();
    CHECK(length > 20.0);
    CHECK(length < 35.0);
    CHECK(std::ranges::all_of(individual.latents(), [](double z) { return std::abs(z) <= 3.0; }));
  }
  // The intersection test finds an intersection.
  gonio::shape::triangle_mesh crossed{gonio::shape::point_columns(3, 6), gonio::shape::triangle_columns(3, 2)};
  crossed.vertices << 0.0, 4.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 4.0, 1.0, 1.0, 2.0, 0.0, 0.0, 0.0, -1.0, 1.0, 1.0;
  crossed.triangles << 0, 3, 1, 4, 2, 5;
  CHECK(intersects_itself(crossed));
}

TEST_CASE("ear canals are functions of a seed and of their latent numbers") {
  const synthetic::ear_canal first = synthetic::ear_canal_family().draw(5),
                             again = synthetic::ear_canal_family().draw(5),
                             other = synthetic::ear_canal_family().draw(6);
  CHECK(first.latents() == again.latents());
  CHECK(first.at(0.3, 1.0) == again.at(0.3, 1.0));
  CHECK(first.latents() != other.latents());
  CHECK(synthetic::ear_canal(first.latents(), first.oddity()).at(0.7, 2.0) == first.at(0.7, 2.0));
  CHECK(synthetic::ear_canal_family(0.0, 0.0).draw(3).at(0.2, 4.0) == synthetic::ear_canal_family::mean().at(0.2, 4.0));
  CHECK((first.at(0.4, 0.0) - first.at(0.4, 2.0 * std::numbers::pi)).norm() < 1e-12);
  CHECK(first.at(1.0, 0.0) == first.at(1.0, 2.0));
  // Each latent number has an effect, but not too large.
  const synthetic::ear_canal plain = synthetic::ear_canal_family::mean();
  for (std::size_t i = 0; i < synthetic::ear_canal::latent_count; ++i) {
    std::vector<double> latents(synthetic::ear_canal::latent_count, 0.0);
    latents[i] = 1.0;
    const synthetic::ear_canal changed(latents);
    double most = 0.0;
    for (int ring = 0; ring < 10; ++ring)
      for (int sector = 0; sector < 7; ++sector)
        most = std::max(most, (changed.at(0.1 * ring, 0.9 * sector) - plain.at(0.1 * ring, 0.9 * sector)).norm());
    CHECK(most > 0.02);
    CHECK(most < 3.0);
  }
  const synthetic::abnormality bump{0.5, 1.0, 1.5, 2.0};
  const synthetic::ear_canal odd(plain.latents(), bump);
  CHECK((odd.at(0.5, 1.0) - plain.at(0.5, 1.0)).norm() == doctest::Approx(1.5).epsilon(1e-6));
  CHECK((odd.at(0.1, 1.0) - plain.at(0.1, 1.0)).norm() < 1e-3);
}

TEST_CASE("scans of ear canals are surfaces, with and without holes") {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const synthetic::ear_canal individual = synthetic::ear_canal_family().draw(seed);
    synthetic::scan_options options = quick_ear_scan();
    options.noise = 0.0;
    const synthetic::ear_scan whole = synthetic::scan_of(individual, ear_template(), seed, options);
    CHECK(whole.mesh.vertices.cols() == 1500);
    CHECK_NOTHROW(gonio::shape::mesh_topology{whole.mesh});
    CHECK(euler_number(whole.mesh) == 1);
    gonio::shape::triangle_mesh unposed = whole.mesh;
    unposed.vertices = whole.placement.inverse() * unposed.vertices;
    CHECK(share_outwards(individual, unposed, whole.parameters) > 0.999);

    for (const bool large : {false, true}) {
      options.hole = large ? synthetic::hole_options::large() : synthetic::hole_options::small();
      options.hole->edge_noise = 0.5;
      options.hole->ragged = 0.45;
      options.hole->flaps = large ? 0.3 : 0.0;
      const synthetic::ear_scan holed = synthetic::scan_of(individual, ear_template(), seed, options);
      CHECK_NOTHROW(gonio::shape::mesh_topology{holed.mesh});
      CHECK(euler_number(holed.mesh) == 0);  // a disc with a hole
      CHECK(uses_all_vertices(holed.mesh));
      CHECK(holed.mesh.vertices.cols() == holed.parameters.cols());
      CHECK(holed.truth == whole.truth);
    }
  }
}

TEST_CASE("scans are triangulated by chance") {
  const synthetic::ear_canal individual = synthetic::ear_canal_family().draw(1);
  synthetic::scan_options options;
  options.complete_vertices = 0;
  const synthetic::ear_scan first = synthetic::scan_of(individual, ear_template(), 1, options),
                            second = synthetic::scan_of(individual, ear_template(), 2, options);
  for (const synthetic::ear_scan* scan : {&first, &second}) {
    CHECK(scan->mesh.vertices.cols() >= 8000);
    CHECK(scan->mesh.vertices.cols() <= 15000);
  }
  CHECK(first.mesh.vertices.cols() != second.mesh.vertices.cols());
  CHECK(std::abs(first.parameters.row(0).minCoeff() - second.parameters.row(0).minCoeff()) > 1e-4);
  CHECK(first.complete.vertices.cols() == 0);
}

TEST_CASE("the truth of a scan lies on the complete surface") {
  synthetic::scan_options options = quick_ear_scan();
  options.complete_vertices = 6000;
  for (const auto defect : {synthetic::scan_defect::none, synthetic::scan_defect::mirrored}) {
    options.defect = defect;
    const synthetic::ear_scan scan =
        synthetic::scan_of(synthetic::ear_canal_family().draw(2), ear_template(), 7, options);
    const gonio::shape::surface_index complete(scan.complete), scanned(scan.mesh);
    double farthest = 0.0, to_scan = 0.0;
    for (Eigen::Index i = 0; i < scan.truth.cols(); i += 7) {
      const Eigen::Vector3d point = scan.truth.col(i);
      const Eigen::Vector2d parameters = ear_template().parameters().col(i);
      CHECK((point - scan.point_at(parameters.x(), parameters.y())).norm() < 1e-12);
      farthest = std::max(farthest, complete.closest(point).distance);
      if (scan.covered[i]) to_scan = std::max(to_scan, scanned.closest(point).distance);
    }
    CHECK(farthest < 0.05);
    CHECK(to_scan < 0.25);
  }
}

TEST_CASE("a scan's noise and pose are as requested") {
  const synthetic::ear_canal individual = synthetic::ear_canal_family().draw(3);
  synthetic::scan_options options = quick_ear_scan();
  CHECK(root_mean_square(offsets_of(synthetic::scan_of(individual, ear_template(), 1, options))) ==
        doctest::Approx(0.03).epsilon(0.1));
  options.noise = 0.2;
  CHECK(root_mean_square(offsets_of(synthetic::scan_of(individual, ear_template(), 1, options))) ==
        doctest::Approx(0.2).epsilon(0.1));
  options.defect = synthetic::scan_defect::heavy_noise;
  CHECK(root_mean_square(offsets_of(synthetic::scan_of(individual, ear_template(), 1, options))) ==
        doctest::Approx(0.6).epsilon(0.1));

  options = quick_ear_scan();
  options.turn = options.tilt = options.shift = options.noise = options.cut = 0.0;
  const synthetic::ear_scan still = synthetic::scan_of(individual, ear_template(), 1, options);
  CHECK(still.placement.matrix() == Eigen::Matrix4d::Identity());
  CHECK(still.truth == ear_template().corresponded(individual));
  CHECK(root_mean_square(offsets_of(still)) < 1e-12);
  CHECK(std::abs(still.parameters.row(0).minCoeff()) < 0.01);

  options = quick_ear_scan();
  double farthest = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    options.vertices = 60;
    const Eigen::Matrix3d turn = synthetic::scan_of(individual, ear_template(), seed, options).placement.linear();
    CHECK((turn.transpose() * turn - Eigen::Matrix3d::Identity()).norm() < 1e-12);
    CHECK(turn(1, 1) > std::cos(13.0 * std::numbers::pi / 180.0));  // up remains up
    farthest = std::max(farthest, std::abs(std::atan2(turn(0, 2), turn(0, 0))) * 180.0 / std::numbers::pi);
  }
  CHECK(farthest > 12.0);
  CHECK(farthest < 23.0);
}

TEST_CASE("holes are at the requested position, with disturbed edges") {
  const synthetic::ear_canal individual = synthetic::ear_canal_family().draw(4);
  synthetic::scan_options options = quick_ear_scan();
  options.vertices = 4000;
  options.noise = 0.0;
  const synthetic::ear_scan whole = synthetic::scan_of(individual, ear_template(), 9, options);
  options.hole = synthetic::hole_options::large();
  options.hole->v = 1.0;
  const synthetic::ear_scan holed = synthetic::scan_of(individual, ear_template(), 9, options);
  const auto lost = [](const synthetic::ear_scan& scan) { return std::ranges::count(scan.covered, false); };
  CHECK(lost(holed) > lost(whole) + 150);
  CHECK(lost(holed) < lost(whole) + 600);
  const gonio::shape::surface_index scanned(holed.mesh);
  const Eigen::Vector3d inside = holed.point_at(0.5, 1.0), across = holed.point_at(0.5, 1.0 + std::numbers::pi);
  CHECK(scanned.closest(inside).distance > 2.0);
  CHECK(scanned.closest(across).distance < 0.1);
  // A missing vertex is far from the scan or nearest to its border.
  for (Eigen::Index i = 0; i < holed.truth.cols(); i += 5) {
    const auto nearest = scanned.closest(holed.truth.col(i));
    if (!holed.covered[i]) CHECK((nearest.on_border || nearest.distance < 0.1));
    if (holed.covered[i]) CHECK(nearest.distance < 0.8);
  }
  for (const auto& point : holed.parameters.colwise())
    CHECK(std::hypot((point.x() - 0.5) / 0.05, std::remainder(point.y() - 1.0, 2.0 * std::numbers::pi) / 0.8) > 1.0);

  options.hole->edge_noise = 0.5;
  const synthetic::ear_scan rough = synthetic::scan_of(individual, ear_template(), 9, options);
  CHECK(rough.mesh.triangles == holed.mesh.triangles);
  std::vector<double> offsets = offsets_of(rough);
  std::erase_if(offsets, [](double offset) { return std::abs(offset) < 1e-9; });
  CHECK(offsets.size() > 100);
  CHECK(offsets.size() < 1500);
  CHECK(root_mean_square(offsets) == doctest::Approx(0.5).epsilon(0.15));

  options.hole->flaps = 0.5;
  const synthetic::ear_scan flapped = synthetic::scan_of(individual, ear_template(), 9, options);
  CHECK(flapped.mesh.triangles.cols() > holed.mesh.triangles.cols() + 10);
  CHECK_NOTHROW(gonio::shape::mesh_topology{flapped.mesh});
}

TEST_CASE("parts that touch in a point or are cut off are removed from a scan") {
  // Two triangles that share only vertex 2, and a separate larger strip.
  synthetic::sampled_surface sampled;
  sampled.mesh.vertices = gonio::shape::point_columns::Random(3, 10);
  sampled.mesh.triangles.resize(3, 5);
  sampled.mesh.triangles << 0, 2, 5, 7, 8, 1, 3, 6, 6, 6, 2, 4, 7, 8, 9;
  sampled.parameters = synthetic::parameter_columns::Random(2, 10);
  sampled.normals = sampled.mesh.vertices;
  const gonio::shape::point_columns before = sampled.mesh.vertices;
  const std::vector<Eigen::Index> left = sampled.keep_where([](Eigen::Index) { return true; });
  CHECK(left == std::vector<Eigen::Index>{5, 6, 7, 8, 9});
  CHECK(sampled.mesh.triangles.cols() == 3);
  CHECK(sampled.mesh.vertices.col(4) == before.col(9));
  CHECK_NOTHROW(gonio::shape::mesh_topology{sampled.mesh});
  CHECK_THROWS_AS((void)sampled.keep_where([](Eigen::Index) { return false; }), gonio::error);
}

TEST_CASE("defective scans have their defect") {
  const synthetic::ear_canal individual = synthetic::ear_canal_family().draw(11);
  synthetic::scan_options options = quick_ear_scan();
  options.noise = 0.0;
  const synthetic::ear_scan good = synthetic::scan_of(individual, ear_template(), 4, options);
  const auto with = [&](synthetic::scan_defect defect) {
    options.defect = defect;
    synthetic::ear_scan scan = synthetic::scan_of(individual, ear_template(), 4, options);
    CHECK(scan.defect == defect);
    CHECK_NOTHROW(gonio::shape::mesh_topology{scan.mesh});
    return scan;
  };

  // A reflection, but no rotation, aligns a mirrored ear with the other. Its triangles still face outwards.
  const synthetic::ear_scan mirrored = with(synthetic::scan_defect::mirrored);
  CHECK(mirrored.placement.linear().determinant() == doctest::Approx(-1.0));
  const gonio::shape::point_columns normals = gonio::shape::area_normals(mirrored.mesh);
  double outwards = 0.0;
  for (Eigen::Index t = 0; t < normals.cols(); ++t) {
    const Eigen::Vector2d parameters = mirrored.parameters.col(mirrored.mesh.triangles(0, t));
    const Eigen::Vector3d truth = mirrored.placement.linear() * individual.normal(parameters.x(), parameters.y());
    outwards += normals.col(t).dot(truth) > 0.0 ? 1.0 : 0.0;
  }
  CHECK(outwards / static_cast<double>(normals.cols()) > 0.999);
  const Eigen::Matrix3d turn = mirrored.placement.linear() * good.placement.linear().inverse();
  CHECK((mirrored.truth -
         ((turn * (good.truth.colwise() - good.placement.translation())).colwise() + mirrored.placement.translation()))
            .norm() < 1e-9);

  const synthetic::ear_scan half = with(synthetic::scan_defect::half);
  CHECK(half.mesh.vertices.cols() < 1200);
  CHECK(half.mesh.vertices.cols() > 300);
  CHECK((half.parameters.row(0).maxCoeff() < 0.5 || half.parameters.row(0).minCoeff() >= 0.5));

  const synthetic::ear_scan turned = with(synthetic::scan_defect::upside_down);
  CHECK(turned.placement.linear()(1, 1) < -0.9);
  CHECK(turned.placement.linear()(0, 0) > 0.9);
  CHECK(turned.placement.linear().determinant() == doctest::Approx(1.0));

  options.complete_vertices = 500;
  const synthetic::ear_scan other = with(synthetic::scan_defect::other_object);
  CHECK(other.truth.cols() == 0);
  CHECK(other.covered.empty());
  CHECK(euler_number(other.mesh) == 1);
  CHECK_NOTHROW(gonio::shape::mesh_topology{other.complete});
  double volume = 0.0;  // positive if triangles face outwards
  const Eigen::Vector3d middle = other.mesh.vertices.rowwise().mean();
  for (Eigen::Index t = 0; t < other.mesh.triangles.cols(); ++t)
    volume += (other.mesh.corners(t).colwise() - middle).determinant() / 6.0;
  CHECK(volume > 500.0);
}

TEST_CASE("populations are functions of a seed, whatever their size") {
  synthetic::scan_options options = quick_ear_scan();
  options.vertices = 200;
  options.hole = synthetic::hole_options::small();
  const synthetic::ear_canal_template coarse(200);
  const auto all = synthetic::population(synthetic::ear_canal_family(), coarse, 60, 3, 0.4, options);
  const auto few = synthetic::population(synthetic::ear_canal_family(), coarse, 5, 3, 0.4, options);
  REQUIRE(all.size() == 60);
  for (Eigen::Index i = 0; i < std::ssize(few); ++i) CHECK(equal_scans(all[i], few[i]));
  CHECK_FALSE(equal_scans(all[0], synthetic::population(synthetic::ear_canal_family(), coarse, 1, 4, 0.4, options)[0]));
  std::map<synthetic::scan_defect, int> kinds;
  for (const synthetic::ear_scan& scan : all) {
    ++kinds[scan.defect];
    CHECK_NOTHROW(gonio::shape::mesh_topology{scan.mesh});
  }
  CHECK(kinds.size() == 6);
  CHECK(kinds[synthetic::scan_defect::none] > 26);
  CHECK(kinds[synthetic::scan_defect::none] < 46);
  for (const synthetic::ear_scan& scan :
       synthetic::population(synthetic::ear_canal_family(), coarse, 5, 3, 0.0, options))
    CHECK(scan.defect == synthetic::scan_defect::none);
}

TEST_CASE("scans of any size and hole are surfaces") {
  CHECK(rc::check("a scan is a surface that uses all its vertices", [] {
    synthetic::scan_options options = quick_ear_scan();
    options.vertices = static_cast<Eigen::Index>(*rc::gen::inRange(50, 800));
    options.noise = 0.0;
    synthetic::hole_options hole;
    hole.length = *rc::gen::inRange(1, 12);
    hole.share = 0.1 * *rc::gen::inRange(1, 12);
    hole.ragged = 0.4;
    hole.flaps = 0.1 * *rc::gen::inRange(0, 10);
    options.hole = hole;
    const auto seed = *rc::gen::arbitrary<std::uint64_t>();
    static const synthetic::ear_canal_template coarse(50);
    const synthetic::ear_scan scan =
        synthetic::scan_of(synthetic::ear_canal_family().draw(seed), coarse, seed, options);
    RC_ASSERT(uses_all_vertices(scan.mesh));
    (void)gonio::shape::mesh_topology{scan.mesh};
  }));
}

TEST_CASE("impossible ear canals and scans are refused") {
  CHECK_THROWS_WITH_AS((void)synthetic::ear_canal({1.0, 2.0}), "an ear canal was given 2 latent numbers, not 56",
                       gonio::error);
  CHECK_THROWS_AS((void)synthetic::ear_canal(std::vector<double>(56, std::numeric_limits<double>::quiet_NaN())),
                  gonio::error);
  CHECK_THROWS_AS((void)synthetic::ear_canal_family(1.5), gonio::error);
  CHECK_THROWS_AS((void)synthetic::ear_canal_family(1.0, -0.1), gonio::error);
  CHECK_THROWS_AS((void)synthetic::ear_canal_template(49), gonio::error);
  const synthetic::ear_canal mean = synthetic::ear_canal_family::mean();
  synthetic::scan_options options = quick_ear_scan();
  options.noise = -1.0;
  CHECK_THROWS_WITH_AS((void)synthetic::scan_of(mean, ear_template(), 1, options),
                       "a scan's noise must be finite and not negative, not -1.000000", gonio::error);
  options = quick_ear_scan();
  options.hole = synthetic::hole_options{};
  options.hole->length = 0.0;
  CHECK_THROWS_AS((void)synthetic::scan_of(mean, ear_template(), 1, options), gonio::error);
  options.hole = synthetic::hole_options{};
  options.hole->ragged = 0.5;
  CHECK_THROWS_AS((void)synthetic::scan_of(mean, ear_template(), 1, options), gonio::error);
  CHECK_THROWS_AS((void)synthetic::population(synthetic::ear_canal_family(), ear_template(), 1, 1, 1.5), gonio::error);
}
