#pragma once
/// Bodies of basis/rbf.hpp.

#include <gonio/basis/basis.hpp>
#include <gonio/basis/rbf.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/random.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <iterator>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE std::vector<half_difference> farthest_point_centres(const valid_cells& cells, Eigen::Index count,
                                                                 std::uint64_t seed) {
  constexpr Eigen::Index most_candidates = 60'000;
  const std::vector<Eigen::Index> candidates = random_choice(cells.size(), most_candidates, seed);
  std::mt19937_64 generator(seed);
  Eigen::Array3Xd coordinates(3, std::ssize(candidates));
  for (Eigen::Index i = 0; i < std::ssize(candidates); ++i)
    coordinates.col(i) = radial_coordinates(cells.angles(candidates[i])).array();

  std::vector<half_difference> centres;
  Eigen::Index farthest = std::uniform_int_distribution<Eigen::Index>(0, coordinates.cols() - 1)(generator);
  Eigen::ArrayXd nearest =  // squared distance to the nearest centre
      Eigen::ArrayXd::Constant(coordinates.cols(), std::numeric_limits<double>::infinity());
  while (std::ssize(centres) < count && nearest[farthest] > 0.0) {
    centres.push_back(cells.angles(candidates[farthest]));
    const Eigen::Array3d centre = coordinates.col(farthest);
    nearest = nearest.min((coordinates.colwise() - centre).square().colwise().sum().transpose());
    nearest.maxCoeff(&farthest);
  }
  if (std::ssize(centres) < count)
    refuse(
        {"cannot choose ", count, " different centres of radial basis functions among ", centres.size(), " locations"});
  return centres;
}

}  // namespace gonio
