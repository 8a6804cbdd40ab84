#include "small_ears.hpp"
#include <gonio/shape/bootstrap.hpp>

#include <doctest/doctest.h>

TEST_CASE("a model of twelve learns from scans of its kind, and from no others") {
  const small_ears ears(12);
  std::vector<gonio::shape::named_scan> scans;
  std::vector<synthetic::ear_scan> truths;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    synthetic::scan_options how;
    if (seed == 3) how.defect = synthetic::scan_defect::mirrored;
    if (seed == 5) how.defect = synthetic::scan_defect::other_object;
    if (seed == 6) how.defect = synthetic::scan_defect::half;
    truths.push_back(ears.scan(seed, how));
    scans.push_back({"scan-" + std::to_string(seed), truths.back().mesh});
  }
  scans.push_back({"nothing", {}});
  gonio::shape::bootstrap_options options;
  options.passes = 2;
  options.registration.fit.most_iterations = 30;
  const auto grown =
      gonio::shape::bootstrap_shape_model(ears.shapes, ears.names, ears.common.mesh().triangles, scans, options);
  REQUIRE(grown.outcomes.size() == 7);
  CHECK(grown.model.shapes() == 12 + grown.accepted());
  CHECK(grown.accepted() >= 2);
  for (const Eigen::Index wrong : {Eigen::Index{2}, Eigen::Index{4}, Eigen::Index{5}, Eigen::Index{6}}) {
    CHECK_FALSE(grown.outcomes[wrong].accepted());
    CHECK(grown.outcomes[wrong].refusal.size() > 10);
  }
  for (std::size_t i = 0; i < truths.size(); ++i) {
    if (!grown.outcomes[i].accepted()) continue;
    const gonio::shape::registration& found = *grown.outcomes[i].registered;
    const gonio::shape::point_columns truth = found.pose(truths[i].truth);
    // A model of twelve shapes does not keep vertices from sliding.
    CHECK((found.vertices - truth).colwise().norm().mean() < 2.0);
    CHECK(found.angle > 15.0);
    CHECK(found.normal_agreement > 0.75);
  }
}
