#include "synthetic_shapes.hpp"
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/shape/alignment.hpp>

#include <Eigen/Geometry>
#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cstdint>
#include <iostream>  // rapidcheck.h does not include what it uses
#include <limits>
#include <random>

using gonio::shape::align;
using gonio::shape::alignment_kind;
using gonio::shape::point_columns;
using gonio::shape::similarity_transform;

namespace {

point_columns scattered_points(Eigen::Index count, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  point_columns points(3, count);
  for (double& number : points.reshaped()) number = static_cast<double>(generator() >> 11) * 0x1p-53 - 0.5;
  return points;
}

/// Returns a random rotation, a translation of up to 50 and a scale from 0.25 to 4.
similarity_transform scattered_pose(std::uint64_t seed, alignment_kind kind) {
  const point_columns numbers = scattered_points(4, seed);
  const Eigen::Quaterniond turn(numbers.reshaped().head<4>());
  const double scale = kind == alignment_kind::similarity ? std::exp2(4.0 * numbers(0, 3)) : 1.0;
  return {scale, turn.normalized().toRotationMatrix(), 100.0 * numbers.col(2)};
}

double difference(const similarity_transform& a, const similarity_transform& b) {
  return std::abs(a.scale - b.scale) + (a.rotation - b.rotation).norm() + (a.translation - b.translation).norm();
}

double squared_distance(const similarity_transform& pose, const point_columns& from, const point_columns& onto,
                        const Eigen::VectorXd& weights) {
  return (pose(from) - onto).colwise().squaredNorm().dot(weights);
}

std::uint64_t any_alignment_seed() { return *rc::gen::arbitrary<std::uint64_t>(); }

alignment_kind any_kind() { return *rc::gen::element(alignment_kind::rigid, alignment_kind::similarity); }

}  // namespace

TEST_CASE("a pose is found again from three points or more") {
  CHECK(rc::check([] {
    const alignment_kind kind = any_kind();
    const point_columns from = scattered_points(*rc::gen::inRange(3, 30), any_alignment_seed());
    const similarity_transform pose = scattered_pose(any_alignment_seed(), kind);
    RC_ASSERT(difference(align(from, pose(from), kind), pose) < 1e-9);
  }));
}

TEST_CASE("without weights an alignment is Eigen's umeyama") {
  CHECK(rc::check([] {
    const alignment_kind kind = any_kind();
    const point_columns from = scattered_points(12, any_alignment_seed()),
                        onto = scattered_points(12, any_alignment_seed());
    const Eigen::Matrix4d expected = Eigen::umeyama(from, onto, kind == alignment_kind::similarity);
    const similarity_transform found = align(from, onto, kind);
    RC_ASSERT((found.scale * found.rotation - expected.topLeftCorner<3, 3>()).norm() < 1e-9);
    RC_ASSERT((found.translation - expected.topRightCorner<3, 1>()).norm() < 1e-9);
    RC_ASSERT(std::abs(found.rotation.determinant() - 1.0) < 1e-12);
  }));
}

TEST_CASE("a weight of k counts as k points, and 0 as none") {
  CHECK(rc::check([] {
    const alignment_kind kind = any_kind();
    const point_columns from = scattered_points(6, any_alignment_seed()),
                        onto = scattered_points(6, any_alignment_seed());
    const Eigen::VectorXd weights = (Eigen::VectorXd(6) << 1, 2, 0, 3, 1, 1).finished();
    const Eigen::ArrayXi repeated = (Eigen::ArrayXi(8) << 0, 1, 1, 3, 3, 3, 4, 5).finished();
    const similarity_transform expected = align(from(Eigen::all, repeated), onto(Eigen::all, repeated), kind);
    RC_ASSERT(difference(align(from, onto, kind, weights), expected) < 1e-9);
    RC_ASSERT(difference(align(from, onto, kind, 1e-200 * weights), expected) < 1e-9);
  }));
}

TEST_CASE("no pose nearby is better") {
  CHECK(rc::check([] {
    const alignment_kind kind = any_kind();
    const point_columns from = scattered_points(9, any_alignment_seed()),
                        onto = scattered_points(9, any_alignment_seed());
    const Eigen::VectorXd weights = scattered_points(3, any_alignment_seed()).reshaped().array() + 0.6;
    const similarity_transform found = align(from, onto, kind, weights);
    const double least = squared_distance(found, from, onto, weights);
    const point_columns change = 1e-3 * scattered_points(3, any_alignment_seed());
    similarity_transform other = found;
    const Eigen::Vector3d turn = change.col(0);
    other.rotation = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * other.rotation;
    other.translation += change.col(1);
    if (kind == alignment_kind::similarity) other.scale *= 1.0 + change(0, 2);
    RC_ASSERT(squared_distance(other, from, onto, weights) > least);
  }));
}

TEST_CASE("a mirror image is never made") {
  const point_columns from = scattered_points(20, 7);
  const point_columns mirrored = Eigen::Vector3d(-1.0, 1.0, 1.0).asDiagonal() * from;
  const similarity_transform found = align(from, mirrored, alignment_kind::similarity);
  CHECK(found.rotation.determinant() == doctest::Approx(1.0));
  CHECK((found(from) - mirrored).norm() > 0.1);
  CHECK(found.scale < 1.0);
}

TEST_CASE("transforms compose and are undone as matrices are") {
  CHECK(rc::check([] {
    const auto first = scattered_pose(any_alignment_seed(), alignment_kind::similarity);
    const auto second = scattered_pose(any_alignment_seed(), alignment_kind::similarity);
    const point_columns points = scattered_points(5, any_alignment_seed());
    RC_ASSERT(((second * first)(points)-second(first(points))).norm() < 1e-9);
    RC_ASSERT((first.inverse()(first(points)) - points).norm() < 1e-9);
    RC_ASSERT((first(points.col(2)) - first(points).col(2)).norm() < 1e-12);
  }));
  const similarity_transform pose{
      2.0, Eigen::AngleAxisd(gonio::radians(90), Eigen::Vector3d::UnitZ()).toRotationMatrix(), {0.0, 0.0, 1.0}};
  CHECK((pose(Eigen::Vector3d(1.0, 0.0, 0.0)) - Eigen::Vector3d(0.0, 2.0, 1.0)).norm() < 1e-12);
}

TEST_CASE("points that leave an alignment undetermined are refused") {
  const point_columns from = scattered_points(5, 1), onto = scattered_points(5, 2);
  const auto refused = [](const point_columns& a, const point_columns& b, const Eigen::VectorXd& weights,
                          const char* why) {
    CHECK_THROWS_WITH_AS(align(a, b, alignment_kind::rigid, weights), doctest::Contains(why), gonio::error);
  };
  CHECK_NOTHROW(align(from, onto));
  refused(from, onto.leftCols(4), {}, "5 and 4");
  refused(from.leftCols(2), onto.leftCols(2), {}, "three points of positive weight, not 2");
  refused(point_columns(3, 0), point_columns(3, 0), {}, "not 0");
  refused(from, onto, Eigen::VectorXd::Ones(4), "5 points has 4 weights");
  refused(from, onto, (Eigen::VectorXd(5) << 1, 1, 1, 1, -1).finished(), "not negative");
  refused(from, onto, (Eigen::VectorXd(5) << 1, 1, 0, 0, 0).finished(), "not 2");
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  refused(from, onto, Eigen::VectorXd::Constant(5, nan), "finite");
  point_columns broken = from;
  broken(1, 2) = nan;
  refused(broken, onto, {}, "finite");
  refused(from, broken, {}, "finite");
  refused(1e200 * from, 1e200 * onto, {}, "so far apart");
  // Points on a line far from the origin, one repeated point, and a mirrored cube, which three rotations fit equally.
  point_columns line = Eigen::Vector3d(1.0, 2.0, -3.0) * Eigen::RowVectorXd::LinSpaced(5, -1.0, 1.0);
  line.colwise() += Eigen::Vector3d(1000.0, -300.0, 77.0);
  refused(line, line, {}, "on a line");
  refused(line, onto, {}, "on a line");
  refused(from, line, {}, "on a line");
  refused(point_columns::Constant(3, 5, 0.1), onto, {}, "rotation undetermined");
  point_columns cube(3, 6);
  cube << Eigen::Matrix3d::Identity(), -Eigen::Matrix3d::Identity();
  refused(cube, Eigen::Vector3d(-1.0, 1.0, 1.0).asDiagonal() * cube, {}, "rotation undetermined");
  point_columns plane = from;
  plane.row(2).setZero();
  CHECK_NOTHROW(align(plane, plane));
}

TEST_CASE("shapes that differ in pose alone meet at once, in the coordinates of the first") {
  for (const auto kind : {alignment_kind::rigid, alignment_kind::similarity}) {
    const point_columns shape = scattered_points(15, 3);
    std::vector<point_columns> posed{shape};
    for (std::uint64_t seed = 10; seed < 15; ++seed) posed.push_back(scattered_pose(seed, kind)(shape));
    const auto [aligned, mean, iterations] = gonio::shape::procrustes_mean(posed, {.kind = kind});
    CHECK(iterations <= 3);
    for (const point_columns& one : aligned) CHECK((one - mean).norm() < 1e-9);
    const similarity_transform to_first = align(mean, shape, kind);
    CHECK((to_first.rotation - Eigen::Matrix3d::Identity()).norm() < 1e-9);
    CHECK((mean.rowwise().mean() - shape.rowwise().mean()).norm() < 1e-9);
  }
}

TEST_CASE("each aligned shape is one of the given ones, and best aligned with the mean of all") {
  const auto shapes = synthetic_shapes(40, 12, 5, 3);
  std::vector<point_columns> posed;
  for (std::size_t i = 0; i < shapes.size(); ++i) posed.push_back(scattered_pose(i, alignment_kind::rigid)(shapes[i]));
  const auto [aligned, mean, iterations] = gonio::shape::procrustes_mean(posed);
  CHECK(iterations > 1);
  point_columns sum = point_columns::Zero(3, 40);
  for (std::size_t i = 0; i < aligned.size(); ++i) {
    const similarity_transform still = align(aligned[i], mean);
    CHECK((still(aligned[i]) - aligned[i]).norm() < 1e-6);
    CHECK((align(posed[i], aligned[i])(posed[i]) - aligned[i]).norm() < 1e-9);
    sum += aligned[i];
  }
  CHECK((sum / 12.0 - mean).norm() < 1e-9);
  // The pose in which a shape was scanned does not matter, except for the first shape.
  std::vector<point_columns> others = posed;
  for (std::size_t i = 1; i < others.size(); ++i) others[i] = scattered_pose(100 + i, alignment_kind::rigid)(others[i]);
  CHECK((gonio::shape::procrustes_mean(others).mean - mean).norm() < 1e-6);
}

TEST_CASE("the mean of similar shapes keeps their mean size") {
  const auto shapes = synthetic_shapes(40, 12, 5, 4);
  double size = 0.0;
  for (const point_columns& shape : shapes) size += gonio::shape::detail::centroid_size(shape) / 12.0;
  const auto [aligned, mean, iterations] = gonio::shape::procrustes_mean(shapes, {.kind = alignment_kind::similarity});
  CHECK(gonio::shape::detail::centroid_size(mean) == doctest::Approx(size));
  for (const point_columns& shape : aligned)
    CHECK(difference(align(shape, mean, alignment_kind::similarity), {}) < 1e-6);
}

TEST_CASE("shapes that do not correspond are refused") {
  const auto shapes = synthetic_shapes(10, 4, 2, 5);
  const auto refused = [](const std::vector<point_columns>& set, const gonio::shape::procrustes_options& options,
                          const char* why) {
    CHECK_THROWS_WITH_AS((void)gonio::shape::procrustes_mean(set, options), doctest::Contains(why), gonio::error);
  };
  refused({}, {}, "at least one shape");
  refused({shapes[0], shapes[1].leftCols(9)}, {}, "shape 1 has 9 points where the first has 10");
  refused(shapes, {.tolerance = 0.0}, "positive tolerance");
  refused(shapes, {.most_iterations = 0}, "at least one iteration");
  refused(shapes, {.most_iterations = 1}, "still changes after 1 iterations");
  CHECK(gonio::shape::procrustes_mean({shapes[0]}).iterations == 1);
}
