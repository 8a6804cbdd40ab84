#pragma once
/// A whole measurement in memory: scans and their calibration.

#include "dark_room.hpp"
#include <gonio/capture/calibration.hpp>
#include <gonio/capture/scan.hpp>

#include <map>
#include <span>
#include <vector>

namespace lab {

/// A scan record in memory.
struct scan_in_memory {
  std::map<Eigen::Index, gonio::capture::reading> readings{};

  [[nodiscard]] bool has(Eigen::Index pose) const { return readings.contains(pose); }
  void add(Eigen::Index pose, const gonio::capture::reading& taken) { readings.emplace(pose, taken); }
};
static_assert(gonio::capture::scan_record<scan_in_memory>);

/// Returns the readings of all poses. Throws gonio::capture::device_failure if one remains missing.
template <gonio::capture::goniometer Machine>
[[nodiscard]] std::vector<gonio::capture::reading> measure_all(Machine& machine,
                                                               std::span<const gonio::direction_pair> poses) {
  scan_in_memory record;
  const gonio::capture::scan_outcome outcome = gonio::capture::scan(machine, poses, record);
  if (!outcome.is_complete())
    throw gonio::capture::device_failure("pose " + std::to_string(outcome.missing.front().number) + ": " +
                                         outcome.missing.front().reason);
  std::vector<gonio::capture::reading> all;
  for (auto& [pose, taken] : record.readings) all.push_back(std::move(taken));
  return all;
}

/// Returns the BRDF measured by scans of a material and of the white reference at the same poses. The camera's response
/// is estimated from both scans.
[[nodiscard]] inline std::vector<gonio::capture::measured_reflectance> calibrate(
    const std::vector<gonio::capture::reading>& material, const std::vector<gonio::capture::reading>& reference,
    std::span<const gonio::direction_pair> poses, const sensor& chip, const gonio::capture::sensor_noise& noise) {
  std::vector<gonio::capture::reading> both = reference;
  both.insert(both.end(), material.begin(), material.end());
  const gonio::capture::calibration known{gonio::capture::estimate_responses(both, chip.largest_count), noise, 0.99,
                                          static_cast<std::uint16_t>(0.98 * chip.largest_count)};
  std::vector<gonio::capture::measured_reflectance> measured;
  for (Eigen::Index i = 0; i < std::ssize(poses); ++i)
    measured.push_back(gonio::capture::measure_reflectance(material[i], reference[i], poses[i], known));
  return measured;
}

}  // namespace lab
