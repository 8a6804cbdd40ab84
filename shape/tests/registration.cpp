#include "small_ears.hpp"
#include <gonio/shape/registration.hpp>
#include <gonio/shape/surface_distance.hpp>
#include <gonio/shape/surface_noise.hpp>

#include <doctest/doctest.h>

TEST_CASE("a registered scan is a shape of the model's vertices on the scan") {
  const small_ears& ears = small_ears::of_sixty();
  const synthetic::ear_scan scan = ears.scan(7);
  const gonio::shape::surface_index index(scan.mesh);
  const auto pose = gonio::shape::align(scan.truth, ears.model.mean().vertices);
  const gonio::shape::registration found = gonio::shape::register_scan(ears.model, index, pose);
  CHECK_MESSAGE(found.accepted(), found.refusal);
  CHECK(gonio::shape::distance_to(index, found.pose.inverse()(found.vertices)).absolute_mean < 0.05);
  CHECK((found.vertices - found.pose(scan.truth)).colwise().norm().mean() < 1.5);
}

TEST_CASE("a scan may be realigned in each round: its pose stays right, and the shape stays on it") {
  const small_ears& ears = small_ears::of_sixty();
  const synthetic::ear_scan scan = ears.scan(7);
  const gonio::shape::surface_index index(scan.mesh);
  const auto right = gonio::shape::align(scan.truth, ears.model.mean().vertices);
  const auto registered = [&](bool realigns) {
    gonio::shape::registration_options options;
    options.fit.holds_pose = true;
    options.realigns = realigns;
    const auto found = gonio::shape::register_scan(ears.model, index, right, options);
    CHECK(gonio::shape::distance_to(index, found.pose.inverse()(found.vertices)).absolute_mean < 0.05);
    return found.pose;
  };
  const auto held = registered(false), anew = registered(true);
  CHECK(held.rotation == right.rotation);
  CHECK(held.translation == right.translation);
  CHECK(anew.translation != right.translation);
  CHECK((anew.rotation * anew.rotation.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-9);
  CHECK((anew(scan.truth) - right(scan.truth)).colwise().norm().mean() < 0.3);
}

TEST_CASE("each failed test of a registration gives its sentence") {
  const small_ears& ears = small_ears::of_sixty();
  const synthetic::ear_scan scan = ears.scan(7, small_ears::with_hole());
  const gonio::shape::surface_index index(scan.mesh);
  const auto pose = gonio::shape::align(scan.truth, ears.model.mean().vertices);
  const auto refusal = [&](const gonio::shape::registration_options& options) {
    return gonio::shape::register_scan(ears.model, index, pose, options).refusal;
  };
  gonio::shape::registration_options options;
  options.most_missing = 0.05;
  CHECK(refusal(options).starts_with("it does not show"));
  options.most_missing = 1.0;
  CHECK(refusal(options).empty());
  options.least_angle = 55.0;
  CHECK(refusal(options).starts_with("a fifth of its triangles have an angle below"));
  options.least_angle = 15.0;
  options.least_normal_agreement = 0.9999;
  CHECK(refusal(options).starts_with("its normals agree with the fit's normals to"));
  options.confidence = 1e-6;
  CHECK(refusal(options).starts_with("the Mahalanobis distance of its weights is"));
}

TEST_CASE("the smallest angles of triangles") {
  gonio::shape::triangle_mesh mesh;
  mesh.vertices.resize(3, 4);
  mesh.vertices << 0, 1, 0, 1, 0, 0, 1, 3, 0, 0, 0, 0;
  mesh.triangles.resize(3, 2);
  mesh.triangles << 0, 1, 1, 3, 2, 2;
  CHECK(gonio::shape::smallest_angle_percentile(mesh, 1.0) == doctest::Approx(45.0));
  CHECK(gonio::shape::smallest_angle_percentile(mesh, 0.0) < 30.0);
}

TEST_CASE("averaging over neighbours hardly moves a border") {
  const small_ears ears(12);
  const gonio::shape::triangle_mesh mean = ears.model.mean();
  const gonio::shape::point_columns smooth =
      gonio::shape::averaged_over_neighbours(ears.model.topology(), mean.vertices);
  double rim = 0.0;
  for (Eigen::Index v = 0; v < ears.model.vertices(); ++v)
    if (ears.model.topology().on_border(v)) rim = std::max(rim, (smooth - mean.vertices).col(v).norm());
  CHECK(rim > 0.0);
  CHECK(rim < 0.2);
}
