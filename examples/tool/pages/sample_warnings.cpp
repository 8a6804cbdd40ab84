#include "sample_warnings.hpp"

#include "fixed.hpp"
#include <gonio/core/statistics.hpp>
#include <gonio/table/viewer_side.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <numbers>
#include <ranges>
#include <utility>

namespace cli {

namespace {

/// Samples by their half and difference angles in thousandths of a degree. The fourth number is the azimuth of the
/// light (of the viewer, if the light is along the normal), or 0 if azimuths do not matter.
using repeats = std::map<std::array<std::int64_t, 4>, std::vector<Eigen::Index>>;

std::int64_t thousandths(double angle) { return std::llround(1e3 * gonio::degrees(angle)); }

std::int64_t turn_of(const gonio::direction_pair& pair) {
  const bool is_along_normal = std::hypot(pair.wi.x(), pair.wi.y()) < 1e-6;
  return thousandths(gonio::azimuth(is_along_normal ? pair.wo : pair.wi));
}

repeats grouped_by_angles(const gonio::sample_set& samples, bool with_azimuths) {
  repeats groups;
  for (Eigen::Index i = 0; i < std::ssize(samples); ++i) {
    if (!samples[i].weight.counts()) continue;
    const gonio::half_difference angles = samples[i].angles();
    const std::int64_t turn = with_azimuths ? turn_of(samples[i].directions.pair()) : 0;
    groups[{thousandths(angles.theta_h), thousandths(angles.theta_d), thousandths(angles.phi_d), turn}].push_back(i);
  }
  return groups;
}

repeats grouped(const gonio::sample_set& samples) { return grouped_by_angles(samples, looks_anisotropic(samples)); }

/// Of all groups of repeats, takes the group in which the green values differ by the largest factor, and describes its
/// two most different samples.
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
               " have the same directions, but the values " + reflectance(green(first)) + " and " +
               reflectance(green(second)) + (is_grey(samples[first].value) ? "" : " (green)");
  }
  return sentence;
}

/// Asks about saturation if the largest value is frequent: a saturated detector repeats one number and reads no larger.
std::string saturation(const gonio::sample_set& samples) {
  constexpr std::ptrdiff_t suspicious = 4;
  std::map<double, std::ptrdiff_t> times;
  for (const gonio::sample& s : samples) ++times[s.value.maxCoeff()];
  if (times.size() < 3 || times.rbegin()->second < suspicious) return {};
  const auto [largest, count] = *times.rbegin();
  times.erase(std::prev(times.end()));
  const std::ptrdiff_t usual = std::ranges::max(times | std::views::values);
  if (count <= 2 * usual) return {};  // numbers with few digits, or repeats
  return std::to_string(count) + " samples have exactly the largest value, " + fixed(largest, 4) +
         ": was the detector saturated? The highlight may be brighter than the estimate says";
}

/// Asks about the dark signal if more than half of the samples are negative; fewer are noise.
std::string darkness(const gonio::sample_set& samples) {
  const auto negative = std::ranges::count_if(samples, [](const gonio::sample& s) { return s.value.maxCoeff() < 0.0; });
  if (2 * negative <= std::ssize(samples)) return {};
  return std::to_string(negative) + " of " + std::to_string(samples.size()) +
         " samples are negative: was the subtracted dark signal too large?";
}

bool all_equal(const gonio::sample_set& samples) {
  return std::ranges::all_of(samples,
                             [&](const gonio::sample& s) { return (s.value == samples.begin()->value).all(); });
}

/// Are light, viewer and normal of each sample in one plane, to half a degree?
bool all_in_plane(const gonio::sample_set& samples) {
  const double tolerance = std::sin(gonio::radians(0.5));
  return std::ranges::all_of(samples, [&](const gonio::sample& s) {
    const gonio::direction_pair pair = s.directions.pair();
    return std::abs(pair.wi.x() * pair.wo.y() - pair.wi.y() * pair.wo.x()) < tolerance;
  });
}

constexpr std::size_t fewest = 3;

/// Are all angles below 3.2, and not all 0? In radians, no polar angle exceeds 1.6, and theta_h + theta_d does not
/// exceed 3.2.
bool looks_like_radians(const gonio::sample_set& samples) {
  if (samples.size() < fewest) return false;
  const double nearest = std::cos(gonio::radians(3.2));
  const auto is_near = [&](const gonio::sample& s) {
    return std::min(s.directions.pair().wi.z(), s.directions.pair().wo.z()) > nearest;
  };
  const auto is_along_normal = [](const gonio::sample& s) {
    return std::min(s.directions.pair().wi.z(), s.directions.pair().wo.z()) >= 1.0;
  };
  return std::ranges::all_of(samples, is_near) && !std::ranges::all_of(samples, is_along_normal);
}

/// A sample away from the highlight: the mean of its channels, and the cosine of the viewer's angle.
struct dull_reading {
  double value, cosine;
};

std::vector<dull_reading> dull_readings(const gonio::sample_set& samples) {
  std::vector<dull_reading> readings;
  for (const gonio::sample& s : samples)
    if (s.angles().theta_h > gonio::radians(30.0)) readings.push_back({s.value.mean(), s.directions.pair().wo.z()});
  return readings;
}

/// Do the values fall like the cosine, that is, with slope 1 in logarithms?
bool fall_like_cosine(const std::vector<dull_reading>& readings) {
  constexpr std::size_t enough = 8;
  if (readings.size() < enough) return false;
  Eigen::ArrayXd x(std::ssize(readings)), y(std::ssize(readings));
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (!(readings[i].value > 0.0)) return false;
    x[i] = std::log(readings[i].cosine);
    y[i] = std::log(readings[i].value);
  }
  // The cosine must vary by a factor of 2 to determine a slope.
  if (x.maxCoeff() - x.minCoeff() < std::log(2.0)) return false;
  x -= x.mean();
  y -= y.mean();
  const double products = (x * y).sum(), slope = products / x.square().sum();
  const double correlation = products / std::sqrt(x.square().sum() * y.square().sum());
  return std::abs(slope - 1.0) < 0.3 && correlation > 0.9;
}

/// Returns the upper median reflectance of the samples away from the highlight, relative to white; 0 for fewer than 5.
double typical_reflectance_factor(const std::vector<dull_reading>& readings) {
  constexpr std::size_t enough = 5;
  if (readings.size() < enough) return 0.0;
  std::vector<double> values;
  for (const dull_reading& each : readings) values.push_back(each.value);
  return std::numbers::pi * gonio::upper_median(values);
}

/// White may be slightly above 1, from noise and an imperfect reference.
constexpr double brightest = 1.05;

/// Returns the likely quantity of values that are impossible as `read_as`; empty if they are possible.
std::string likely_quantity(double reflectance_factor, gonio::io::sample_quantity read_as) {
  using gonio::io::sample_quantity;
  if (!(reflectance_factor > brightest) || read_as == sample_quantity::percent) return "";
  if (read_as == sample_quantity::reflectance_factor) return reflectance_factor <= 100.0 * brightest ? "percent" : "";
  const double value = reflectance_factor / std::numbers::pi;
  if (value <= brightest) return "reflectance factors (--quantity reflectance-factor)";
  return value <= 100.0 * brightest ? "percent (--quantity percent)" : "";
}

}  // namespace

bool looks_anisotropic(const gonio::sample_set& samples) {
  constexpr double noticeable = 0.25;
  constexpr std::size_t fewest_groups = 5;
  std::vector<double> differences;
  for (const auto& [angles, numbers] : grouped_by_angles(samples, false)) {
    const auto turn = [&](Eigen::Index i) { return turn_of(samples[i].directions.pair()); };
    const auto value = [&](Eigen::Index i) { return samples[i].value.y(); };
    const auto [first, last] = std::ranges::minmax(numbers | std::views::transform(turn));
    const auto [low, high] = std::ranges::minmax(numbers | std::views::transform(value));
    if (last > first && high > 0.0) differences.push_back(1.0 - low / high);
  }
  return differences.size() >= fewest_groups && gonio::upper_median(differences) > noticeable;
}

std::vector<std::string> doubts_of(const gonio::io::sample_file& file) {
  const gonio::sample_set samples = file.samples.in_three_channels();
  std::vector<std::string> sentences;
  if (looks_like_radians(samples))
    sentences.emplace_back(
        "light and viewer of all samples are within 3.2 degrees of the normal: are the angles in radians? They are "
        "read as degrees, except in columns like 'theta_i [rad]'");
  const auto read_as = file.quantity.value_or(gonio::io::sample_quantity::brdf);
  const std::vector<dull_reading> readings = dull_readings(samples);
  const double reflectance_factor = typical_reflectance_factor(readings);
  if (const std::string likely = likely_quantity(reflectance_factor, read_as); !likely.empty())
    sentences.push_back("away from highlights, half of the samples reflect more than " + fixed(reflectance_factor, 1) +
                        " times as much as a white diffuser: are the values " + likely + "?");
  if (read_as != gonio::io::sample_quantity::brdf_cosine && fall_like_cosine(readings))
    sentences.emplace_back(
        "away from highlights, the values fall like the cosine of the viewer's angle: do they contain this cosine "
        "(--quantity brdf-cosine)?");
  // Whoever states `light` has answered the question below.
  const bool asks = file.sign != gonio::io::theta_o_sign::light;
  if (const double ratio = asks ? gonio::brightness_towards_light(samples) : 0.0;
      ratio > gonio::implausible_brightness_towards_light)
    sentences.push_back("where light and viewer have the same direction, the sample is " + fixed(ratio, 1) +
                        " times as bright as in the mirror direction: " +
                        (file.sign ? "is a positive theta_o on the light's side (--theta-o-sign light)?"
                                   : "does the material reflect light back (--theta-o-sign light), or is theta_o or "
                                     "its azimuth counted from the mirror direction (--theta-o-sign mirror)?"));
  return sentences;
}

std::vector<std::string> warnings_of(const gonio::sample_set& samples, double noise) {
  std::vector<std::string> sentences;
  if (noise > 0.5)
    sentences.push_back("noise of " + fixed(100.0 * noise, 0) + " % is very large: do you mean " + fixed(noise, 2) +
                        " %, --noise " + fixed(noise / 100.0, 4) + "?");
  if (std::string sentence = contradiction(samples, noise); !sentence.empty()) sentences.push_back(std::move(sentence));
  for (std::string sentence : {saturation(samples), darkness(samples)})
    if (!sentence.empty()) sentences.push_back(std::move(sentence));
  if (samples.size() < fewest) return sentences;
  if (all_equal(samples)) sentences.emplace_back("all samples have the same value");
  if (all_in_plane(samples))
    sentences.emplace_back(
        "all samples are in the plane of incidence: directions outside it are predicted from other materials alone "
        "(gonio design --given finds the directions that help most)");
  return sentences;
}

Eigen::Index repeated_samples(const gonio::sample_set& samples) {
  Eigen::Index repeats = 0;
  for (const auto& [angles, numbers] : grouped(samples)) repeats += std::ssize(numbers) - 1;
  return repeats;
}

}  // namespace cli
