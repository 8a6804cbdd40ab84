#include "../synthetic_materials.hpp"
#include <gonio/estimate/sample_regions.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <functional>
#include <random>

using gonio::sample_regions;

TEST_CASE("regions are equal parts: strips of theta_h, cut by theta_d") {
  CHECK(rc::check([] {
    const std::size_t n = *rc::gen::inRange(1, 600);
    std::mt19937 generator(static_cast<unsigned>(n));
    std::vector<gonio::location> locations;
    for (std::size_t i = 0; i < n; ++i)
      locations.push_back(gonio::locate_cell(small_cells(), generator() % small_cells().size()));
    const sample_regions regions(locations);
    const std::size_t strips = std::clamp<std::size_t>(n / 8, 1, 6),
                      parts = std::clamp<std::size_t>(n / strips / 8, 1, 4);
    RC_ASSERT(regions.count() == strips * parts);
    RC_ASSERT(regions.all().size() == n);
    std::vector<bool> seen(n, false);
    double largest_h = -1.0;
    for (std::size_t strip = 0; strip < strips; ++strip) {
      double largest_d = -1.0, here = largest_h;
      for (std::size_t part = 0; part < parts; ++part) {
        const auto region = regions[strip * parts + part];
        RC_ASSERT(region.size() >= n / regions.count());
        RC_ASSERT(region.size() <= n / regions.count() + 2);
        for (const Eigen::Index sample : region) {
          RC_ASSERT(!seen[sample]);
          seen[sample] = true;
          RC_ASSERT(locations[sample].angles.theta_h >= largest_h);
          RC_ASSERT(locations[sample].angles.theta_d >= largest_d);
          here = std::max(here, locations[sample].angles.theta_h);
          largest_d = locations[sample].angles.theta_d;
        }
      }
      largest_h = here;
    }
    RC_ASSERT(std::ranges::all_of(seen, std::identity{}));
  }));
}

TEST_CASE("no samples are one empty region") {
  const sample_regions regions({});
  CHECK(regions.count() == 1);
  CHECK(regions[0].empty());
}
