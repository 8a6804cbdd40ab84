#include "../synthetic_materials.hpp"
#include <gonio/design/sphere_geometry.hpp>

#include <doctest/doctest.h>

TEST_CASE("the slices of theta_d hold all valid cells, each once") {
  const gonio::design::sphere_geometry spheres(small_cells());
  CHECK(spheres.size() == 7);
  std::vector<int> seen(small_cells().size(), 0);
  for (Eigen::Index slice = 0; slice < spheres.size(); ++slice) {
    REQUIRE(spheres.allows(slice));
    const auto cells = spheres.cells_of(slice);
    const auto directions = spheres.directions(slice);
    REQUIRE(directions.size() == cells.size());
    CHECK(spheres.nearest(spheres.centre(slice)) == slice);
    for (Eigen::Index i = 0; i < std::ssize(cells); ++i) {
      ++seen[cells[i]];
      CHECK(directions[i].theta_d == doctest::Approx(gonio::radians((static_cast<double>(slice) + 0.5) * 90 / 7)));
    }
  }
  CHECK(std::ranges::all_of(seen, [](int times) { return times == 1; }));
}

TEST_CASE("steps go along theta_d and end at its ends") {
  const gonio::design::sphere_geometry spheres(small_cells());
  CHECK(spheres.stepped(2, {0, 3, 0}) == Eigen::Index{5});
  CHECK(spheres.stepped(5, {0, -3, 0}) == Eigen::Index{2});
  CHECK_FALSE(spheres.stepped(5, {0, 2, 0}).has_value());
  CHECK_FALSE(spheres.stepped(1, {0, -3, 0}).has_value());
  CHECK_FALSE(spheres.stepped(1, {1, 0, 0}).has_value());
}

TEST_CASE("light and camera stay as far apart as they must") {
  const gonio::design::sphere_geometry any(small_cells()), apart(small_cells(), gonio::radians(30));
  Eigen::Index lost = 0;
  for (Eigen::Index slice = 0; slice < any.size(); ++slice) {
    const auto [wi, wo] = any.centre(slice);
    CHECK(apart.allows(slice) == (gonio::angle_between(wi, wo) >= gonio::radians(30)));
    if (!apart.allows(slice)) ++lost;
  }
  CHECK(lost > 0);
  CHECK(lost < any.size());
}
