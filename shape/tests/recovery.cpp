#include "small_ears.hpp"
#include <gonio/core/error.hpp>
#include <gonio/shape/hole_filling.hpp>
#include <gonio/shape/recovery.hpp>
#include <gonio/shape/surface_distance.hpp>

#include <doctest/doctest.h>

namespace {

/// A scan with a hole, and the error of its recovery there.
struct recovered_hole {
  synthetic::ear_scan scan;
  gonio::shape::surface_index index, complete;
  gonio::shape::similarity_transform pose;
  std::vector<Eigen::Index> hole;

  recovered_hole(const small_ears& ears, std::uint64_t seed)
      : scan(ears.scan(seed, small_ears::with_hole())),
        index(scan.mesh),
        complete(scan.complete),
        pose(gonio::shape::align(scan.truth, ears.model.mean().vertices)) {
    for (std::size_t v = 0; v < scan.covered.size(); ++v)
      if (!scan.covered[v] && ears.common.parameters()(0, v) > 0.1) hole.push_back(v);
  }

  [[nodiscard]] double off(const gonio::shape::point_columns& vertices,
                           const gonio::shape::similarity_transform& to_model) const {
    const gonio::shape::point_columns recovered =
        to_model.inverse()(gonio::shape::point_columns(vertices(Eigen::all, hole)));
    return gonio::shape::distance_to(complete, recovered).absolute_mean;
  }
};

}  // namespace

TEST_CASE("a large hole is recovered closer to the truth than a thin plate fills it") {
  const small_ears& ears = small_ears::of_sixty();
  double ours = 0.0, thin_plate = 0.0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const recovered_hole judge(ears, seed);
    const gonio::shape::recovered_shape found = gonio::shape::recover(ears.model, judge.index, judge.pose);
    ours += judge.off(found.surface.vertices, found.pose);
    gonio::shape::point_columns shown = found.surface.vertices;
    shown(Eigen::all, found.known.vertices) = found.known.positions;
    const auto known = gonio::shape::marks_of(found.known, ears.model.vertices());
    thin_plate += judge.off(gonio::shape::fill_smoothly(ears.model.topology(), shown, known), found.pose);
    // Across the surface, the uncertainty is larger in the hole. Along it, the uncertainty is large everywhere.
    const gonio::shape::shape_uncertainty uncertainty = found.fit.uncertainty();
    const gonio::shape::point_columns normals = gonio::shape::vertex_normals(found.surface);
    double in_hole = 0.0, elsewhere = 0.0;
    for (Eigen::Index v = 0; v < normals.cols(); ++v)
      (judge.scan.covered[v] ? elsewhere : in_hole) += normals.col(v).dot(uncertainty.covariance(v) * normals.col(v));
    const auto missing = static_cast<double>(std::ranges::count(judge.scan.covered, false));
    CHECK(in_hole / missing > elsewhere / (static_cast<double>(known.size()) - missing));
  }
  MESSAGE("mean absolute distance in the hole: " << ours / 3.0 << " mm, thin plate " << thin_plate / 3.0 << " mm");
  CHECK(ours < 0.6 * thin_plate);
}

TEST_CASE("Algorithm 1 gets closer to the truth from a wrong pose if it aligns in each round") {
  const small_ears& ears = small_ears::of_sixty();
  const recovered_hole judge(ears, 1);
  const gonio::shape::similarity_transform off{1.0, Eigen::Matrix3d::Identity(), {0.7, -0.7, 0.0}};
  const auto off_with = [&](bool aligns) {
    gonio::shape::algorithm_1_options options;
    options.coarse.holds_pose = true;
    options.aligns = aligns;
    options.local_rounds = 0;
    const auto found = gonio::shape::recover_algorithm_1(ears.model, judge.index, off * judge.pose, options);
    if (!aligns) CHECK(found.pose.translation == (off * judge.pose).translation);
    return judge.off(found.surface.vertices, found.pose);
  };
  CHECK(off_with(true) < off_with(false));
}

TEST_CASE("Algorithm 1 recovers, too, with and without its local rounds") {
  const small_ears& ears = small_ears::of_sixty();
  const recovered_hole judge(ears, 1);
  const double spread = judge.off(ears.model.mean().vertices, judge.pose);
  for (const int local_rounds : {0, 2}) {
    gonio::shape::algorithm_1_options options;
    options.local_rounds = local_rounds;
    const auto found = gonio::shape::recover_algorithm_1(ears.model, judge.index, judge.pose, options);
    CHECK(judge.off(found.surface.vertices, found.pose) < spread);
    CHECK(found.known.vertices.size() < 500);
    CHECK(found.known.vertices.size() > 350);
  }
}

TEST_CASE("Algorithm 1 goes on until it converges, so that fitting the pose is no worse than holding the right one") {
  const small_ears& ears = small_ears::of_sixty();
  gonio::shape::algorithm_1_options until_convergence;
  until_convergence.local_rounds = 0;
  until_convergence.confidence = 0.999999;  // refuses none of these ears
  gonio::shape::algorithm_1_options rising_alone = until_convergence, held = until_convergence;
  rising_alone.most_rounds = rising_alone.rounds;
  held.coarse.holds_pose = true;
  held.aligns = false;
  double off_fitted = 0.0, off_rising = 0.0, off_held = 0.0;  // sums over ten ears, mm
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const recovered_hole judge(ears, seed);
    const auto off = [&](const gonio::shape::algorithm_1_options& options) {
      const auto found = gonio::shape::recover_algorithm_1(ears.model, judge.index, judge.pose, options);
      return judge.off(found.surface.vertices, found.pose);
    };
    off_fitted += off(until_convergence);
    off_rising += off(rising_alone);
    off_held += off(held);
  }
  MESSAGE("mean absolute distance in the hole over ten ears: " << 0.1 * off_fitted << " mm, pose held "
                                                               << 0.1 * off_held << " mm, rising rounds alone "
                                                               << 0.1 * off_rising << " mm");
  CHECK(off_fitted < 0.7 * off_rising);
  CHECK(off_fitted < 1.1 * off_held);
}

TEST_CASE("the explained variance rises from the first to the last round and holds") {
  const gonio::shape::algorithm_1_options options;
  CHECK(gonio::shape::detail::explained_variance_in(0, options) == 0.30);
  CHECK(gonio::shape::detail::explained_variance_in(9, options) == 0.999);
  CHECK(gonio::shape::detail::explained_variance_in(5, options) >
        gonio::shape::detail::explained_variance_in(4, options));
}

TEST_CASE("a scan that shows all comes back less noisy") {
  const small_ears& ears = small_ears::of_sixty();
  synthetic::scan_options noisy;
  noisy.noise = 0.15;
  noisy.cut = 0.0;
  const synthetic::ear_scan scan = ears.scan(4, noisy);
  const auto found = gonio::shape::recover(ears.model, gonio::shape::surface_index(scan.mesh),
                                           gonio::shape::align(scan.truth, ears.model.mean().vertices));
  const gonio::shape::surface_index complete(scan.complete);
  const double noise = gonio::shape::distance_to(complete, scan.mesh.vertices).root_mean_square;
  const double left =
      gonio::shape::distance_to(complete, found.pose.inverse()(found.surface.vertices)).root_mean_square;
  CHECK(noise == doctest::Approx(0.15).epsilon(0.1));
  CHECK(left < noise);
}

TEST_CASE("a scan far outside the family is refused by its Mahalanobis distance") {
  const small_ears& ears = small_ears::of_sixty();
  const synthetic::ear_scan ear = ears.scan(5);
  const auto pose = gonio::shape::align(ear.truth, ears.model.mean().vertices);
  const Eigen::Vector3d middle = ear.mesh.vertices.rowwise().mean();
  for (const Eigen::Vector3d& stretched : {Eigen::Vector3d(1.3, 1.3, 1.3), Eigen::Vector3d(1.4, 0.7, 1.0),
                                           Eigen::Vector3d(0.6, 1.3, 1.3), Eigen::Vector3d(0.7, 0.7, 0.7)}) {
    gonio::shape::triangle_mesh scan = ear.mesh;
    scan.vertices = (stretched.asDiagonal() * (ear.mesh.vertices.colwise() - middle)).colwise() + middle;
    CHECK_THROWS_WITH_AS(gonio::shape::recover(ears.model, gonio::shape::surface_index(scan), pose),
                         doctest::Contains("the scan does not fit the model: its Mahalanobis distance"), gonio::error);
  }
}
