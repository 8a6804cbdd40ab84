#include "../synthetic_materials.hpp"
#include <gonio/design/capture_geometry.hpp>

#include <doctest/doctest.h>

namespace {

/// The smallest possible geometry: three candidates in a row, all in the same direction.
struct line_of_candidates {
  [[nodiscard]] Eigen::Index size() const { return 3; }
  [[nodiscard]] bool allows(Eigen::Index) const { return true; }
  [[nodiscard]] gonio::direction_pair centre(Eigen::Index) const { return gonio::to_directions({0.1, 0.2, 0.3}); }
  [[nodiscard]] Eigen::Index nearest(const gonio::direction_pair&) const { return 0; }
  [[nodiscard]] std::vector<gonio::half_difference> directions(Eigen::Index) const { return {{0.1, 0.2, 0.3}}; }
  [[nodiscard]] std::optional<Eigen::Index> stepped(Eigen::Index from, const gonio::design::grid_step& step) const {
    const int to = static_cast<int>(from) + step[0];
    if (to < 0 || to > 2 || step[1] != 0 || step[2] != 0) return {};
    return to;
  }
};
static_assert(gonio::design::capture_geometry<line_of_candidates>);

}  // namespace

TEST_CASE("steps stay on valid cells, and phi_d goes round") {
  const gonio::design::point_geometry points(small_cells());
  for (Eigen::Index from = 0; from < points.size(); from += 7) {
    const auto there = points.stepped(from, {0, 0, 2});
    if (!there) continue;
    CHECK(points.stepped(*there, {0, 0, -2}) == from);
    CHECK(points.stepped(from, {0, 0, 9}) == from);
  }
  CHECK_FALSE(points.stepped(0, {-1, 0, 0}).has_value());
  CHECK_FALSE(points.stepped(points.size() - 1, {1, 0, 0}).has_value());
}

TEST_CASE("a point sample is in the direction of its cell; steps do not lead to what the constraint excludes") {
  gonio::design::capture_constraint constraint;
  constraint.light.largest = gonio::radians(45);
  const gonio::design::point_geometry points(small_cells(), constraint);
  Eigen::Index allowed = 0;
  for (Eigen::Index cell = 0; cell < points.size(); ++cell) {
    const auto angles = points.directions(cell);
    REQUIRE(angles.size() == 1);
    CHECK(angles[0].theta_d == small_cells().angles(cell).theta_d);
    // Light and viewer may be exchanged: one of them must be in the light's range.
    const gonio::cosine_pair cosine = gonio::cosines(angles[0]);
    CHECK(points.allows(cell) == (std::max(cosine.i, cosine.o) >= std::cos(gonio::radians(45))));
    const gonio::direction_pair centre = points.centre(cell);
    CHECK(points.nearest(centre) == cell);
    if (!points.allows(cell)) continue;
    CHECK(constraint(centre));
    ++allowed;
    for (const gonio::design::grid_step& step : {gonio::design::grid_step{1, 0, 0}, {0, -1, 0}, {0, 0, 1}})
      if (const auto to = points.stepped(cell, step)) CHECK(points.allows(*to));
  }
  CHECK(allowed > 0);
  CHECK(allowed < points.size());
}
