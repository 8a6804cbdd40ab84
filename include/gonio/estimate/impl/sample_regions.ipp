#pragma once
/// Bodies of estimate/sample_regions.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/estimate/sample_regions.hpp>
#include <gonio/table/location.hpp>

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE sample_regions::sample_regions(const std::vector<location>& locations)
    : order_(locations.size()), strips_(at_most(6, locations.size())), parts_(at_most(4, locations.size() / strips_)) {
  std::iota(order_.begin(), order_.end(), Eigen::Index{0});
  const auto sort_by = [&](double half_difference::*angle, std::span<Eigen::Index> some) {
    std::vector<std::pair<double, Eigen::Index>> keyed;
    for (const Eigen::Index i : some) keyed.emplace_back(locations[i].angles.*angle, i);
    const std::vector<Eigen::Index> sorted = in_order(std::move(keyed));
    std::copy(sorted.begin(), sorted.end(), some.begin());
  };
  sort_by(&half_difference::theta_h, order_);
  for (Eigen::Index strip = 0; strip < strips_; ++strip)
    sort_by(&half_difference::theta_d, part_of<Eigen::Index>(order_, strip, strips_));
}

}  // namespace gonio
