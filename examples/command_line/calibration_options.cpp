#include "calibration_options.hpp"

#include <cmath>

namespace cli {

void add_calibration_options(command& to, calibration_options& options) {
  to.add_option("--reflectance", options.reflectance, "Of the white reference")
      .check(check::range(0.01, 1.0))
      .capture_default_str();
  to.add_option("--gamma", options.gamma,
                "The camera's response is known: counts are the exposure to the power of 1/gamma (1: linear)")
      .check(check::positive_number());
  to.add_option("--saturation", options.saturation, "Share of the largest count from which a pixel is saturated")
      .check(check::range(0.1, 1.0))
      .capture_default_str();
  to.add_option("--read-noise", options.noise.read, "Deviation of every count")
      .check(check::non_negative_number())
      .capture_default_str();
  to.add_option("--shot-noise", options.noise.shot, "Variance in counts for each count")
      .check(check::non_negative_number())
      .capture_default_str();
  to.add_option("--flicker", options.noise.relative, "Relative deviation of each exposure")
      .check(check::non_negative_number())
      .capture_default_str();
}

std::vector<gonio::capture::reading> readings_of(const gonio::io::recorded_scan& scan) {
  std::vector<gonio::capture::reading> all;
  for (const auto& each : scan.readings)
    if (each) all.push_back(*each);
  return all;
}

gonio::capture::calibration calibration_of(const calibration_options& options,
                                           std::span<const gonio::capture::reading> readings,
                                           std::uint16_t largest_count) {
  const auto saturation = static_cast<std::uint16_t>(std::lround(options.saturation * largest_count));
  if (options.gamma > 0.0) {
    const auto known = gonio::capture::camera_response::power_law(largest_count, options.gamma);
    return {{known, known, known}, options.noise, options.reflectance, saturation};
  }
  return {gonio::capture::estimate_responses(readings, largest_count), options.noise, options.reflectance, saturation};
}

gonio::capture::reference_readings reference_readings_of(const gonio::io::recorded_scan& scan) {
  std::vector<gonio::direction_pair> poses;
  for (std::size_t i = 0; i < scan.poses.size(); ++i)
    if (scan.readings[i]) poses.push_back(scan.poses[i]);
  return {std::move(poses), readings_of(scan)};
}

}  // namespace cli
