#include "small_ears.hpp"
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/shape/fit_to_scan.hpp>
#include <gonio/shape/surface_distance.hpp>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include <cmath>

namespace {

/// Returns the true pose, rotated by some degrees and shifted by some millimetres.
gonio::shape::similarity_transform about_right(const synthetic::ear_scan& scan, const gonio::shape::shape_model& model,
                                               double degrees, double shift) {
  const Eigen::AngleAxisd turn(gonio::radians(degrees), Eigen::Vector3d(1, 2, 2) / 3.0);
  const gonio::shape::similarity_transform off{1.0, turn.toRotationMatrix(), Eigen::Vector3d(shift, -shift, 0.0)};
  return off * gonio::shape::align(scan.truth, model.mean().vertices);
}

}  // namespace

TEST_CASE("a model finds the shape and the pose of a whole scan from an approximate pose") {
  const small_ears& ears = small_ears::of_sixty();
  const synthetic::ear_scan scan = ears.scan(1);
  const gonio::shape::surface_index index(scan.mesh);
  gonio::shape::fit_to_scan_options options;
  options.tolerance = 0.01;
  const auto found = gonio::shape::fit_to_scan(ears.model, index, about_right(scan, ears.model, 6.0, 1.0), options);
  CHECK(found.iterations > 1);
  CHECK(found.iterations < options.most_iterations);
  const gonio::shape::surface_index complete(scan.complete);
  const auto off = gonio::shape::distance_to(complete, found.pose.inverse()(found.shape()));
  CHECK(off.absolute_mean < 0.12);  // a shape of the family is 1.15 mm from the mean
  CHECK(found.squared_distance() > 0.0);
  CHECK(found.weights().size() == std::ssize(ears.model.truncated_to_variance(0.99).basis()));
  // The pose includes the last remaining motion.
  CHECK(found.all_weights.tail<6>().norm() * 1e3 < 0.05);
}

TEST_CASE("at the end of a fit, no motion and no other weights bring the shape closer") {
  const small_ears& ears = small_ears::of_sixty();
  const synthetic::ear_scan scan = ears.scan(1);
  gonio::shape::fit_to_scan_options options;
  options.tolerance = 1e-4;
  const auto found = gonio::shape::fit_to_scan(ears.model, gonio::shape::surface_index(scan.mesh),
                                               about_right(scan, ears.model, 6.0, 1.0), options);
  REQUIRE(found.iterations < options.most_iterations);
  const gonio::shape::shape_with_motion moving(ears.model.truncated_to_variance(options.explained_variance).basis(),
                                               found.shape());
  const gonio::basis_equations equations(moving, gonio::shape::locate_vertices(moving.cells(), found.correspondences));
  const auto [weights, motion] = moving.split(equations.solve(found.solver).weights.col(0));
  const gonio::shape::point_columns change = motion(gonio::shape::shape_of(moving.shape(), weights)) - found.shape();
  CHECK(std::sqrt(change.squaredNorm() / static_cast<double>(change.cols())) < 1e-3);
}

TEST_CASE("a fit to a noisy scan ends at the same shape from different poses") {
  const small_ears& ears = small_ears::of_sixty();
  const synthetic::ear_scan scan = ears.scan(3, small_ears::with_hole());
  const gonio::shape::surface_index index(scan.mesh);
  gonio::shape::fit_to_scan_options options;
  options.position_error = 0.05;
  options.tolerance = 1e-4;
  options.most_iterations = 1000;
  const auto one = gonio::shape::fit_to_scan(ears.model, index, about_right(scan, ears.model, 0.0, 0.0), options);
  const auto other = gonio::shape::fit_to_scan(ears.model, index, about_right(scan, ears.model, 6.0, 1.0), options);
  const gonio::shape::point_columns apart = one.pose.inverse()(one.shape()) - other.pose.inverse()(other.shape());
  CHECK(apart.colwise().norm().mean() < 1e-3);
}

TEST_CASE("vertices in a hole are not among the correspondences") {
  const small_ears& ears = small_ears::of_sixty();
  const synthetic::ear_scan scan = ears.scan(2, small_ears::with_hole());
  const auto found = gonio::shape::fit_to_scan(ears.model, gonio::shape::surface_index(scan.mesh),
                                               about_right(scan, ears.model, 0.0, 0.0));
  const auto marks = gonio::shape::marks_of(found.correspondences, ears.model.vertices());
  std::size_t hidden = 0, shown_though_hidden = 0, shown = 0, uncovered = 0;
  for (std::size_t v = 0; v < marks.size(); ++v) {
    (scan.covered[v] ? shown : hidden) += 1;
    shown_though_hidden += !scan.covered[v] && marks[v];
    uncovered += scan.covered[v] && !marks[v];
  }
  REQUIRE(hidden > 20);
  CHECK(static_cast<double>(shown_though_hidden) < 0.3 * static_cast<double>(hidden));
  CHECK(static_cast<double>(uncovered) < 0.1 * static_cast<double>(shown));
}

TEST_CASE("spurious correspondences get hardly any weight") {
  gonio::shape::point_columns shape = gonio::shape::point_columns::Random(3, 100);
  gonio::shape::vertex_observations correspondences =
      gonio::shape::vertex_observations::marked(shape, std::vector<bool>(100, true));
  correspondences.positions.row(0).array() += 0.05;
  correspondences.positions.col(7).array() += 2.0;
  const Eigen::VectorXd weights = gonio::shape::detail::inlier_weights(correspondences, shape, 0.05);
  CHECK(weights[7] < 1e-3);
  CHECK(weights[8] == doctest::Approx(0.81));  // (1 + 1/9)^-2
}

TEST_CASE("a pose that is wrong is refused") {
  const small_ears& ears = small_ears::of_sixty();
  const synthetic::ear_scan scan = ears.scan(1);
  CHECK_THROWS_WITH_AS(gonio::shape::fit_to_scan(ears.model, gonio::shape::surface_index(scan.mesh),
                                                 about_right(scan, ears.model, 0.0, 100.0)),
                       "the scan shows 0 of the model's 500 vertices, expected at least 10: is its pose right?",
                       gonio::error);
}

TEST_CASE("a held pose stays the same to the last bit, and its error remains in the result") {
  const small_ears& ears = small_ears::of_sixty();
  const synthetic::ear_scan scan = ears.scan(1);
  const gonio::shape::surface_index index(scan.mesh), complete(scan.complete);
  const auto off_with = [&](double degrees, double shift, bool holds_pose) {
    const auto pose = about_right(scan, ears.model, degrees, shift);
    gonio::shape::fit_to_scan_options options;
    options.holds_pose = holds_pose;
    const auto found = gonio::shape::fit_to_scan(ears.model, index, pose, options);
    if (holds_pose) {
      CHECK(found.pose.rotation == pose.rotation);
      CHECK(found.pose.translation == pose.translation);
      CHECK(found.all_weights.tail<6>().norm() == 0.0);
    }
    return gonio::shape::distance_to(complete, found.pose.inverse()(found.shape())).absolute_mean;
  };
  // A correct pose serves as well as a fitted one; a wrong pose does not.
  CHECK(off_with(0.0, 0.0, true) < 1.5 * off_with(0.0, 0.0, false));
  CHECK(off_with(6.0, 1.0, true) > 2.0 * off_with(6.0, 1.0, false));
}
