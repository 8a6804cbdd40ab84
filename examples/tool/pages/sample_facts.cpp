#include "sample_facts.hpp"

#include "fixed.hpp"
#include "measures_as_json.hpp"
#include "sample_warnings.hpp"
#include <gonio/core/direction.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace cli {

namespace {

/// The smallest and the largest of some numbers.
class range {
 public:
  void include(double number) {
    low_ = std::min(low_, number);
    high_ = std::max(high_, number);
  }
  [[nodiscard]] json degrees() const { return {rounded_degrees(low_), rounded_degrees(high_)}; }
  [[nodiscard]] json numbers() const { return {low_, high_}; }

 private:
  double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
};

/// Counts repeated directions, also of samples with zero weight.
Eigen::Index count_repeats(gonio::sample_set samples) {
  for (gonio::sample& s : samples) s.weight = 1.0;
  return repeated_samples(samples);
}

json angles_of(const gonio::sample_set& samples) {
  range theta_i, theta_o, theta_h, theta_d;
  for (const gonio::sample& s : samples) {
    const auto& [wi, wo] = s.directions.pair();
    theta_i.include(gonio::polar_angle(wi));
    theta_o.include(gonio::polar_angle(wo));
    theta_h.include(s.angles().theta_h);
    theta_d.include(s.angles().theta_d);
  }
  return {{"theta_i", theta_i.degrees()},
          {"theta_o", theta_o.degrees()},
          {"theta_h", theta_h.degrees()},
          {"theta_d", theta_d.degrees()},
          {"repeated_directions", count_repeats(samples)}};
}

std::vector<std::string> suspicions_of(const gonio::sample_set& samples, Eigen::Index negative) {
  constexpr double usual_noise = 0.02;
  std::vector<std::string> sentences = cli::warnings_of(samples, usual_noise);
  if (10 * negative > std::ssize(samples))
    sentences.push_back(std::to_string(negative) + " of " + std::to_string(samples.size()) +
                        (negative == 1 ? " samples has a negative value" : " samples have a negative value"));
  const auto grazes = [](const gonio::sample& s) {
    const auto& [wi, wo] = s.directions.pair();
    return std::min(wi.z(), wo.z()) < std::cos(gonio::radians(85.0));
  };
  if (const auto grazing = std::ranges::count_if(samples, grazes); grazing > 0)
    sentences.push_back(counted(grazing, "sample") + (grazing == 1 ? " is" : " are") +
                        " more than 85 degrees from the normal, which few instruments reach: check the values");
  return sentences;
}

}  // namespace

double rounded_degrees(double radians) { return std::round(1e3 * gonio::degrees(radians)) / 1e3; }

json facts_of(const gonio::sample_set& samples) {
  gonio::rgb low = samples.front().value, high = low;
  range weights;
  Eigen::Index negative = 0;
  for (const gonio::sample& s : samples) {
    low = low.min(s.value);
    high = high.max(s.value);
    negative += (s.value < 0.0).any() ? 1 : 0;
    for (const double weight : s.weight.of_each()) weights.include(weight);
  }
  json facts{{"samples", samples.size()}};
  facts.update(angles_of(samples));
  facts["minimum"] = per_channel(low);
  facts["maximum"] = per_channel(high);
  facts["samples_with_negative_values"] = negative;
  facts["weights"] = weights.numbers();
  facts["suspicious"] = suspicions_of(samples, negative);
  return facts;
}

json angles_as_json(const gonio::sample_directions& directions) {
  const auto& [wi, wo] = directions.pair();
  const auto [theta_h, theta_d, phi_d] = directions.angles();
  return {{"theta_i", rounded_degrees(gonio::polar_angle(wi))},
          {"phi_i", rounded_degrees(gonio::azimuth(wi))},
          {"theta_o", rounded_degrees(gonio::polar_angle(wo))},
          {"phi_o", rounded_degrees(gonio::azimuth(wo))},
          {"theta_h", rounded_degrees(theta_h)},
          {"theta_d", rounded_degrees(theta_d)},
          {"phi_d", rounded_degrees(phi_d)}};
}

json facts_of(std::span<const gonio::direction_pair> pairs) {
  gonio::sample_set samples;
  for (const gonio::direction_pair& pair : pairs) samples.push_back({pair, gonio::rgb::Zero(), 1.0});
  json facts{{"directions", pairs.size()}};
  facts.update(angles_of(samples));
  return facts;
}

}  // namespace cli
