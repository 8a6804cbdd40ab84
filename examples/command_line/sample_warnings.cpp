#include "sample_warnings.hpp"

#include "fixed.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

namespace cli {

namespace {

/// Samples of the same half and difference angles, to a thousandth of a degree.
using repeats = std::map<std::array<std::int64_t, 3>, std::vector<Eigen::Index>>;

repeats grouped(const gonio::sample_set& samples) {
  repeats groups;
  for (Eigen::Index i = 0; i < std::ssize(samples); ++i) {
    if (!samples[i].weight.counts()) continue;
    const gonio::half_difference angles = samples[i].angles();
    const auto rounded = [](double angle) { return std::llround(1e3 * gonio::degrees(angle)); };
    groups[{rounded(angles.theta_h), rounded(angles.theta_d), rounded(angles.phi_d)}].push_back(i);
  }
  return groups;
}

/// The two samples whose green values are furthest apart, of the group in which these differ by the largest factor.
std::string contradiction(const gonio::sample_set& samples, double noise) {
  const auto green = [&](Eigen::Index i) { return samples[i].value.y(); };
  double largest = 1.5 * (1.0 + 6.0 * noise);
  std::string sentence;
  for (const auto& [angles, numbers] : grouped(samples)) {
    const auto [low, high] = std::ranges::minmax(numbers, {}, green);
    if (!(green(low) > 0.0) || !(green(high) > largest * green(low))) continue;
    largest = green(high) / green(low);
    const auto [first, second] = std::minmax(low, high);
    sentence = "samples " + std::to_string(first + 1) + " and " + std::to_string(second + 1) +
               " have the same directions, but the values " + fixed(green(first), 3) + " and " +
               fixed(green(second), 3) + " (green)";
  }
  return sentence;
}

bool all_equal(const gonio::sample_set& samples) {
  return std::ranges::all_of(samples,
                             [&](const gonio::sample& s) { return (s.value == samples.begin()->value).all(); });
}

/// Light, viewer and normal of each sample are in one plane, to half a degree.
bool all_in_plane(const gonio::sample_set& samples) {
  const double tolerance = std::sin(gonio::radians(0.5));
  return std::ranges::all_of(samples, [&](const gonio::sample& s) {
    const gonio::direction_pair pair = s.directions.pair();
    return std::abs(pair.wi.x() * pair.wo.y() - pair.wi.y() * pair.wo.x()) < tolerance;
  });
}

}  // namespace

std::vector<std::string> warnings_of(const gonio::sample_set& samples, double noise) {
  std::vector<std::string> sentences;
  if (noise > 0.5)
    sentences.push_back("noise of " + fixed(100.0 * noise, 0) + " % leaves little of the values: is it " +
                        fixed(noise, 2) + " %, that is --noise " + fixed(noise / 100.0, 4) + "?");
  if (std::string sentence = contradiction(samples, noise); !sentence.empty()) sentences.push_back(std::move(sentence));
  constexpr std::size_t fewest = 3;
  if (samples.size() < fewest) return sentences;
  if (all_equal(samples)) sentences.emplace_back("all samples have the same value");
  if (all_in_plane(samples))
    sentences.emplace_back(
        "all samples are in the plane of incidence: what is outside it follows from other materials alone "
        "(gonio design --given says which directions help most)");
  return sentences;
}

Eigen::Index repeated_samples(const gonio::sample_set& samples) {
  Eigen::Index repeats = 0;
  for (const auto& [angles, numbers] : grouped(samples)) repeats += std::ssize(numbers) - 1;
  return repeats;
}

}  // namespace cli
