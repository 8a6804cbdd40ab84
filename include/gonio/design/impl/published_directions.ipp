#pragma once
/// Bodies of design/published_directions.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/design/published_directions.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace gonio::design::detail {

GONIO_INLINE const std::vector<std::vector<printed_direction>>& nielsen_table_1() {
  static const std::vector<std::vector<printed_direction>> table{
      {{0, 66, 0}},
      {{2, 40, 24}, {29, 21, 52}},
      {{1, 4, 36}, {77, 13, 86}, {8, 79, 85}, {3, 74, 145}, {13, 52, 80}},
      {{3, 12, 28},
       {63, 19, 89},
       {5, 77, 77},
       {2, 60, 180},
       {15, 4, 130},
       {1, 6, 37},
       {2, 79, 110},
       {39, 76, 89},
       {0, 71, 104},
       {5, 75, 180}},
      {{9, 12, 69},  {66, 35, 103}, {4, 76, 150}, {3, 79, 107},  {33, 63, 105}, {1, 7, 174},  {21, 8, 180},
       {7, 64, 180}, {6, 73, 180},  {2, 63, 95},  {11, 11, 124}, {6, 74, 123},  {1, 62, 129}, {33, 49, 24},
       {14, 71, 55}, {8, 35, 180},  {31, 77, 91}, {2, 72, 130},  {2, 47, 113},  {10, 43, 68}}};
  return table;
}

}  // namespace gonio::design::detail

namespace gonio::design {

GONIO_INLINE std::vector<half_difference> nielsen_directions(Eigen::Index n) {
  for (const auto& set : detail::nielsen_table_1()) {
    if (std::ssize(set) != n) continue;
    std::vector<half_difference> directions;
    for (const auto& [theta_h, theta_d, phi_d] : set)
      directions.push_back({radians(theta_h), radians(theta_d), radians(phi_d)});
    return directions;
  }
  refuse("there is no published set of " + std::to_string(n) + " directions: choose 1, 2, 5, 10 or 20");
}

GONIO_INLINE std::vector<half_difference> nielsen_sphere_directions(Eigen::Index n) {
  static const std::vector<std::vector<int>> table_2{{5}, {4, 70}, {4, 10, 31, 68, 75}};
  for (const std::vector<int>& set : table_2) {
    if (std::ssize(set) != n) continue;
    std::vector<half_difference> directions;
    for (const int theta_d : set) directions.push_back({0.0, radians(theta_d), 0.0});
    return directions;
  }
  refuse("there is no published set of " + std::to_string(n) + " images of a sphere: choose 1, 2 or 5");
}

GONIO_INLINE std::vector<half_difference> westlund_meyer_directions() {
  std::vector<half_difference> directions;
  const direction light = spherical_direction(radians(45), 0.0);
  for (const double aspecular : {15.0, 25.0, 45.0, 75.0, 110.0})
    directions.push_back(to_half_difference(light, spherical_direction(radians(aspecular - 45.0), 0.0)));
  return directions;
}

}  // namespace gonio::design
