#pragma once
/// A machine and a record for the tests of scans. The tests can make them fail.

#include <gonio/capture/scan.hpp>

#include <functional>
#include <map>
#include <vector>

/// A machine that reaches directions less than 60 degrees from the normal and counts to 100. Before each measurement it
/// runs a function of the test, which may throw or return another measurement.
struct synthetic_machine {
  std::function<void(gonio::capture::reading&)> fault = [](gonio::capture::reading&) {};
  std::vector<gonio::direction_pair> measured{};

  [[nodiscard]] gonio::capture::placement place(const gonio::direction_pair& pair) const {
    const bool low = std::min(pair.wi.z(), pair.wo.z()) < 0.2 || pair.wi.z() < 0.5;
    return {pair, low ? "the lamp is too low" : ""};
  }
  [[nodiscard]] double travel(const gonio::direction_pair& from, const gonio::direction_pair& to) const {
    return gonio::angle_between(from.wo, to.wo);
  }
  [[nodiscard]] std::uint16_t largest_count() const { return 100; }
  [[nodiscard]] gonio::capture::reading measure(const gonio::direction_pair& pair) {
    measured.push_back(pair);
    gonio::capture::reading taken{
        {0.1, 0.2},
        {gonio::capture::camera_frame::Constant(2, 3, 10), gonio::capture::camera_frame::Constant(2, 3, 20)}};
    fault(taken);
    return taken;
  }
};
static_assert(gonio::capture::goniometer<synthetic_machine>);

struct synthetic_record {
  std::map<std::size_t, gonio::capture::reading> kept{};

  [[nodiscard]] bool has(std::size_t pose) const { return kept.contains(pose); }
  void add(std::size_t pose, const gonio::capture::reading& taken) { kept.emplace(pose, taken); }
};
static_assert(gonio::capture::scan_record<synthetic_record>);

/// Returns poses that the machine reaches, at azimuths all around.
inline std::vector<gonio::direction_pair> synthetic_poses(std::size_t count) {
  std::vector<gonio::direction_pair> poses;
  for (std::size_t i = 0; i < count; ++i)
    poses.push_back(
        {gonio::spherical_direction(0.3, 0.0), gonio::spherical_direction(0.5, 2.4 * static_cast<double>(i))});
  return poses;
}
