/// A machine of your own: its driver, a scan that resumes where it was stopped, and the measured values. This machine
/// has no lamp and no camera: it returns the counts that a formula material would give.

#include <gonio/capture/calibration.hpp>
#include <gonio/capture/scan.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/io/measurements/scan_journal.hpp>
#include <gonio/model/formula_materials.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>

struct desk_goniometer {
  gonio::model::formula_brdf sample;  // the sample in the machine

  gonio::capture::placement place(const gonio::direction_pair& pair) const {
    const double lowest = std::max(gonio::polar_angle(pair.wi), gonio::polar_angle(pair.wo));
    return {pair, lowest <= gonio::radians(70.0) ? "" : "the arms end at 70 degrees"};
  }
  double travel(const gonio::direction_pair& from, const gonio::direction_pair& to) const {
    return std::max(gonio::angle_between(from.wi, to.wi), gonio::angle_between(from.wo, to.wo));
  }
  std::uint16_t largest_count() const { return 4095; }
  gonio::capture::reading measure(const gonio::direction_pair& pair) {
    gonio::capture::reading taken;
    for (const double seconds : {0.01, 0.04, 0.16, 0.64}) {
      const gonio::rgb counts = 2e4 * seconds * pair.wi.z() * sample(pair.wi, pair.wo);
      taken.times.push_back(seconds);
      taken.frames.push_back(counts.min(4095.0).transpose().cast<std::uint16_t>());
    }
    return taken;
  }
};
static_assert(gonio::capture::goniometer<desk_goniometer>);

gonio::io::recorded_scan scan(const char* material, const gonio::capture::scan_plan& plan) {
  desk_goniometer machine{gonio::model::formula_material(material)};
  gonio::io::scan_journal journal(std::string(material) + ".scan", {.sample = material, .setup = "desk"}, plan.poses,
                                  machine.largest_count());
  gonio::capture::scan(machine, plan.poses, journal);
  return journal.scan();
}

int main() {
  const auto wanted = gonio::io::read_direction_pairs("nielsen-20.csv");
  const auto plan = gonio::capture::plan_scan(desk_goniometer{gonio::model::formula_material("red-paint")}, wanted);
  std::printf("%zu poses; pair %td: %s\n", plan.poses.size(), plan.unreachable[0].number,
              plan.unreachable[0].reason.c_str());
  const auto white = scan("grey-lambertian", plan), paint = scan("red-paint", plan);

  const auto linear = gonio::capture::camera_response::power_law(4095);
  const gonio::capture::calibration known{.responses = {linear, linear, linear},
                                          .reflectance = 0.18};  // of the white reference
  for (std::size_t i = 0; i < 3; ++i) {
    const auto found =
        gonio::capture::measure_reflectance(*paint.readings[i], *white.readings[i], plan.poses[i], known);
    std::printf("red %.4f +- %.4f sr^-1\n", found.value.x(), found.deviation.x());
  }
}
