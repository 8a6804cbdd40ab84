#include "small_ears.hpp"
#include <gonio/core/error.hpp>
#include <gonio/shape/cross_validated_uncertainty.hpp>

#include <doctest/doctest.h>

namespace {

gonio::shape::recovered_shape recovered(const small_ears& ears, const gonio::shape::surface_index& scan,
                                        const gonio::shape::triangle_mesh& mesh) {
  return gonio::shape::recover(ears.model, scan,
                               gonio::shape::align_by_shape_context(mesh, ears.model.mean()).transform);
}

}  // namespace

TEST_CASE("a measured uncertainty holds the true vertices of scans, along the surface, too") {
  const small_ears& ears = small_ears::of_sixty();
  gonio::shape::cross_validation_options options;
  options.trials = 20;
  std::size_t inside = 0, inside_by_formula = 0, all = 0;
  double along = 0.0, across = 0.0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const synthetic::ear_scan scan = ears.scan(seed, small_ears::with_hole());
    const gonio::shape::surface_index index(scan.mesh);
    const gonio::shape::recovered_shape found = recovered(ears, index, scan.mesh);
    const gonio::shape::cross_validated_uncertainty measured(ears.model, index, found, options);
    CHECK(measured.trials() >= 15);
    CHECK(measured.squared_radius(0.5) < measured.squared_radius(0.95));
    const gonio::shape::shape_uncertainty formula = found.fit.uncertainty();
    const gonio::shape::point_columns truth = found.pose(scan.truth),
                                      normals = gonio::shape::vertex_normals(found.surface);
    for (std::size_t v = 0; v < scan.covered.size(); ++v) {
      const Eigen::Index vertex = v;
      if (scan.covered[v] || ears.common.parameters()(0, vertex) <= 0.1) continue;
      const Eigen::Matrix3d covariance = measured.covariance(vertex);
      const Eigen::Vector3d off = found.surface.vertices.col(vertex) - truth.col(vertex);
      inside += off.dot(covariance.llt().solve(off)) <= measured.squared_radius(0.95);
      inside_by_formula += off.dot(formula.covariance(vertex).llt().solve(off)) <= formula.squared_radius(0.95);
      const double normal = normals.col(vertex).dot(covariance * normals.col(vertex));
      across += normal;
      along += 0.5 * (covariance.trace() - normal);
      ++all;
    }
  }
  MESSAGE(inside << " of " << all << " are inside, " << inside_by_formula << " by V{s1|s2}");
  CHECK(static_cast<double>(inside) > 0.85 * static_cast<double>(all));
  CHECK(along > across);  // vertices slide
}

TEST_CASE("the uncertainty is the same for any number of threads, and differs for another seed") {
  const small_ears& ears = small_ears::of_sixty();
  const synthetic::ear_scan scan = ears.scan(2, small_ears::with_hole());
  const gonio::shape::surface_index index(scan.mesh);
  const gonio::shape::recovered_shape found = recovered(ears, index, scan.mesh);
  gonio::shape::cross_validation_options options;
  options.trials = 10;
  options.parts = 2;
  const gonio::shape::cross_validated_uncertainty one(ears.model, index, found, options, gonio::thread_count{1});
  const gonio::shape::cross_validated_uncertainty two(ears.model, index, found, options, gonio::thread_count{2});
  options.seed = 2;
  const gonio::shape::cross_validated_uncertainty other(ears.model, index, found, options);
  for (Eigen::Index vertex = 0; vertex < ears.model.vertices(); vertex += 50) {
    CHECK(one.covariance(vertex) == two.covariance(vertex));
    CHECK(one.covariance(vertex) != other.covariance(vertex));
  }
  CHECK(one.squared_radius(0.9) == two.squared_radius(0.9));
  // Ten shapes give the quantile 10/11 and no higher one.
  REQUIRE(one.trials() == 10);
  CHECK(one.squared_radius(0.9) < one.squared_radius(0.92));
  CHECK(one.squared_radius(0.92) == one.squared_radius(0.999));
  for (const double share : {0.0, 1.0, std::numeric_limits<double>::quiet_NaN()})
    CHECK_THROWS_AS((void)one.squared_radius(share), gonio::error);
}

TEST_CASE("impossible numbers of trials or parts are refused") {
  const small_ears& ears = small_ears::of_sixty();
  const synthetic::ear_scan scan = ears.scan(1);
  const gonio::shape::surface_index index(scan.mesh);
  const gonio::shape::recovered_shape found = recovered(ears, index, scan.mesh);
  const auto refused = [&](std::size_t trials, std::size_t parts, const std::string& words) {
    gonio::shape::cross_validation_options options;
    options.trials = trials;
    options.parts = parts;
    CHECK_THROWS_WITH_AS((void)gonio::shape::cross_validated_uncertainty(ears.model, index, found, options),
                         words.c_str(), gonio::error);
  };
  refused(9, 5, "from 10 to 60 shapes can be left out, not 9");
  refused(61, 5, "from 10 to 60 shapes can be left out, not 61");
  refused(10, 1,
          "60 shapes cannot be left out in 1 parts: expected at least 2 parts that each leave at least 2 shapes");
  refused(10, 61,
          "60 shapes cannot be left out in 61 parts: expected at least 2 parts that each leave at least 2 shapes");
}
