#include "calibration_options.hpp"

#include <gonio/io/measurements/reference_reflectance.hpp>
#include <gonio/io/text/text.hpp>

#include <cmath>

namespace cli {

void add_reflectance_option(command& to, std::filesystem::path& given) {
  to.add_input("--reflectance", given,
               "Reflectance of the white reference: a number, or a table by the angles of light and viewer (.csv, "
               "docs/reference/formats.md)")
      .type_name("FLOAT|FILE")
      .default_str(given.string());
}

std::optional<double> number_of_reflectance(const std::filesystem::path& given) {
  double number = 0.0;
  if (gonio::io::read_number(given.native(), number) != nullptr) return {};
  if (!(number >= 0.01 && number <= 1.0))
    gonio::refuse({"--reflectance ", given.native(), ": expected a number from 0.01 to 1, or the file of a table"});
  return number;
}

gonio::capture::reference_reflectance reflectance_of(const std::filesystem::path& given) {
  const std::optional<double> number = number_of_reflectance(given);
  return number ? *number : gonio::io::read_reference_reflectance(given);
}

void add_calibration_options(command& to, calibration_options& options) {
  add_reflectance_option(to, options.reflectance);
  to.add_option("--gamma", options.gamma,
                "Known camera response: counts are the exposure to the power of 1/gamma (1: linear)")
      .check(check::positive_number());
  to.add_option("--saturation", options.saturation, "Saturation level, as a share of the largest count")
      .check(check::range(0.1, 1.0))
      .capture_default_str();
  to.add_option("--read-noise", options.noise.read, "Read noise: standard deviation in counts")
      .check(check::non_negative_number())
      .capture_default_str();
  to.add_option("--shot-noise", options.noise.shot, "Shot noise: variance in counts^2 per count of signal")
      .check(check::non_negative_number())
      .capture_default_str();
  to.add_option("--flicker", options.noise.relative, "Relative standard deviation of each exposure")
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
  const gonio::capture::reference_reflectance reflectance = reflectance_of(options.reflectance);
  const auto saturation = static_cast<std::uint16_t>(std::lround(options.saturation * largest_count));
  if (options.gamma > 0.0) {
    const auto known = gonio::capture::camera_response::power_law(largest_count, options.gamma);
    return {{known, known, known}, options.noise, reflectance, saturation};
  }
  return {gonio::capture::estimate_responses(readings, largest_count), options.noise, reflectance, saturation};
}

gonio::capture::reference_readings reference_readings_of(const gonio::io::recorded_scan& scan) {
  std::vector<gonio::direction_pair> poses;
  for (std::size_t i = 0; i < scan.poses.size(); ++i)
    if (scan.readings[i]) poses.push_back(scan.poses[i]);
  return {std::move(poses), readings_of(scan)};
}

}  // namespace cli
