#pragma once
/// Bodies of estimate/inliers.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/estimate/inliers.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE std::vector<Eigen::Index> inliers::kept() const {
  constexpr double least_weight = 0.01;
  std::vector<Eigen::Index> positions;
  for (Eigen::Index i = 0; i < weights.size(); ++i)
    if (weights[i] >= least_weight) positions.push_back(i);
  return positions;
}

GONIO_INLINE inliers all_inliers(Eigen::Index n) { return {Eigen::VectorXd::Ones(n), {}}; }

GONIO_INLINE located_samples weighted(const located_samples& samples, const inliers& found) {
  const std::vector<Eigen::Index> kept = found.kept();
  located_samples some = samples.subset(kept);
  for (Eigen::Index c = 0; c < some.weights.cols(); ++c)
    for (Eigen::Index i = 0; i < some.size(); ++i) some.weights(i, c) *= found.weights[kept[i]];
  return some;
}

GONIO_INLINE inliers detail::inliers_of(const Eigen::VectorXd& probabilities, const std::vector<Eigen::Index>& first) {
  const Eigen::Index n = probabilities.size();
  inliers found{Eigen::VectorXd::Ones(n) - probabilities, first};
  std::vector<bool> is_named(n, false);
  for (const Eigen::Index i : first) is_named[i] = true;
  std::vector<std::pair<double, Eigen::Index>> by_weight;
  for (Eigen::Index i = 0; i < n; ++i)
    if (!is_named[i] && found.weights[i] < 0.5) by_weight.emplace_back(found.weights[i], i);
  for (const Eigen::Index i : detail::in_order(std::move(by_weight))) found.rejected.push_back(i);
  if (n > 0) found.outlier_share = probabilities.sum() / static_cast<double>(n);
  return found;
}

GONIO_INLINE std::vector<Eigen::Index> detail::numbers_at(const std::vector<Eigen::Index>& numbers,
                                                          const std::vector<Eigen::Index>& positions) {
  std::vector<Eigen::Index> some;
  for (const Eigen::Index i : positions) some.push_back(numbers[i]);
  return some;
}

GONIO_INLINE std::vector<Eigen::Index> detail::wrong_neighbours(const located_samples& samples,
                                                                const Eigen::VectorXd& probabilities,
                                                                const correlation_lengths& lengths) {
  // Sort by neighbourhood.
  std::vector<std::array<Eigen::Index, 4>> where(samples.size());
  std::vector<Eigen::Index> sorted(samples.size());
  for (Eigen::Index i = 0; i < samples.size(); ++i) {
    const Eigen::Vector4d place = discrepancy_place(samples.locations[i].angles, lengths);
    for (Eigen::Index c = 0; c < 4; ++c) where[i][c] = static_cast<Eigen::Index>(std::floor(place[c]));
    sorted[i] = i;
  }
  std::ranges::stable_sort(sorted, [&](Eigen::Index one, Eigen::Index other) {
    return std::ranges::lexicographical_compare(where[one], where[other]);
  });
  // Take those of neighbourhoods where three of four are wrong.
  std::vector<Eigen::Index> found;
  for (auto begin = sorted.begin(); begin != sorted.end();) {
    const auto end = std::find_if(begin, sorted.end(), [&](Eigen::Index i) { return where[i] != where[*begin]; });
    const auto is_wrong = [&](Eigen::Index i) { return probabilities[i] > 0.5; };
    const auto wrong = std::count_if(begin, end, is_wrong);
    if (wrong >= 2 && 4 * wrong >= 3 * (end - begin)) std::copy_if(begin, end, std::back_inserter(found), is_wrong);
    begin = end;
  }
  std::ranges::sort(found);
  return found;
}

}  // namespace gonio
