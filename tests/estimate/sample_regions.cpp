#include "../made_up_materials.hpp"
#include <gonio/estimate/sample_regions.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

using gonio::sample_regions;

TEST_CASE("regions are equal parts of the samples in the order of theta_h") {
  CHECK(rc::check([] {
    const auto n = static_cast<std::size_t>(*rc::gen::inRange(1, 2000));
    std::vector<gonio::location> places;
    for (std::size_t i = 0; i < n; ++i)
      places.push_back(gonio::locate_cell(
          small_cells(), static_cast<std::size_t>(*rc::gen::inRange(0, static_cast<int>(small_cells().size())))));
    const sample_regions regions(places);
    RC_ASSERT(regions.count() == std::clamp<std::size_t>(n / 100, 1, 8));
    RC_ASSERT(regions.all().size() == n);
    std::vector<bool> seen(n, false);
    double largest = -1.0;
    for (std::size_t region = 0; region < regions.count(); ++region) {
      RC_ASSERT(regions[region].size() >= n / regions.count());
      RC_ASSERT(regions[region].size() <= n / regions.count() + 1);
      for (const std::size_t sample : regions[region]) {
        RC_ASSERT(!seen[sample]);
        seen[sample] = true;
        RC_ASSERT(places[sample].angles.theta_h >= largest);
        largest = places[sample].angles.theta_h;
      }
    }
    RC_ASSERT(std::ranges::all_of(seen, std::identity{}));
  }));
}

TEST_CASE("no samples are one empty region") {
  const sample_regions regions({});
  CHECK(regions.count() == 1);
  CHECK(regions[0].empty());
}
