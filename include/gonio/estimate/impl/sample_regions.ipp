#pragma once
/// Bodies of estimate/sample_regions.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/estimate/sample_regions.hpp>
#include <gonio/table/location.hpp>

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

namespace gonio {

GONIO_INLINE sample_regions::sample_regions(const std::vector<location>& locations)
    : order_(locations.size()), strips_(at_most(6, locations.size())), parts_(at_most(4, locations.size() / strips_)) {
  std::iota(order_.begin(), order_.end(), Eigen::Index{0});
  const auto sort_by = [&](double half_difference::*angle, std::span<Eigen::Index> some) {
    std::ranges::sort(some, [&](Eigen::Index one, Eigen::Index other) {
      const double first = locations[one].angles.*angle, second = locations[other].angles.*angle;
      return first != second ? first < second : one < other;
    });
  };
  sort_by(&half_difference::theta_h, order_);
  for (Eigen::Index strip = 0; strip < strips_; ++strip)
    sort_by(&half_difference::theta_d, part_of<Eigen::Index>(order_, strip, strips_));
}

}  // namespace gonio
