#include "small_ears.hpp"
#include <gonio/shape/bootstrap.hpp>

#include <doctest/doctest.h>

TEST_CASE("a model of twelve learns from scans of its kind, and from no others") {
  const small_ears ears(12);
  std::vector<gonio::named_scan> scans;
  std::vector<lab::ear_scan> truths;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    lab::scan_options how;
    if (seed == 3) how.defect = lab::scan_defect::mirrored;
    if (seed == 5) how.defect = lab::scan_defect::other_object;
    if (seed == 6) how.defect = lab::scan_defect::half;
    truths.push_back(ears.scan(seed, how));
    scans.push_back({"scan-" + std::to_string(seed), truths.back().mesh});
  }
  scans.push_back({"nothing", {}});
  const auto grown = gonio::bootstrap_shape_model(ears.shapes, ears.names, ears.common.mesh().triangles, scans);
  REQUIRE(grown.outcomes.size() == 7);
  CHECK(grown.model.shapes() == 12 + grown.accepted());
  CHECK(grown.accepted() >= 2);
  for (const std::size_t wrong : {std::size_t{2}, std::size_t{4}, std::size_t{5}, std::size_t{6}}) {
    CHECK_FALSE(grown.outcomes[wrong].accepted());
    CHECK(grown.outcomes[wrong].refusal.size() > 10);
  }
  for (std::size_t i = 0; i < truths.size(); ++i) {
    if (!grown.outcomes[i].accepted()) continue;
    const gonio::registration& found = *grown.outcomes[i].registered;
    const gonio::point_columns truth = found.pose(truths[i].truth);
    CHECK((found.vertices - truth).colwise().norm().mean() < 2.0);
    CHECK(found.angle > 15.0);
    CHECK(found.normal_agreement > 0.75);
  }
}

TEST_CASE("the smallest angles of triangles") {
  gonio::triangle_mesh mesh;
  mesh.vertices.resize(3, 4);
  mesh.vertices << 0, 1, 0, 1, 0, 0, 1, 3, 0, 0, 0, 0;
  mesh.triangles.resize(3, 2);
  mesh.triangles << 0, 1, 1, 3, 2, 2;
  CHECK(gonio::smallest_angle_percentile(mesh, 1.0) == doctest::Approx(45.0));
  CHECK(gonio::smallest_angle_percentile(mesh, 0.0) < 30.0);
}

TEST_CASE("averaging over neighbours keeps a border in its place") {
  const small_ears ears(12);
  const gonio::triangle_mesh mean = ears.model.mean();
  const gonio::point_columns smooth = gonio::averaged_over_neighbours(ears.model.topology(), mean.vertices);
  double rim = 0.0;
  for (Eigen::Index v = 0; v < ears.model.vertices(); ++v)
    if (ears.model.topology().on_border(v)) rim = std::max(rim, (smooth - mean.vertices).col(v).norm());
  CHECK(rim > 0.0);
  CHECK(rim < 0.2);
}
