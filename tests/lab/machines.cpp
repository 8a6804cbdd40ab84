#include "synthetic_scan.hpp"
#include <gonio/core/statistics.hpp>
#include <gonio/model/formula_materials.hpp>

#include <doctest/doctest.h>
#include <lab/gantry.hpp>
#include <lab/robot.hpp>

namespace {

const std::array linear_cameras{gonio::capture::camera_response::power_law(65535),
                                gonio::capture::camera_response::power_law(65535),
                                gonio::capture::camera_response::power_law(65535)};

/// Scans of the white reference and of the material in the same room, at the poses that the machine makes of pairs.
template <gonio::capture::goniometer Machine>
struct two_scans {
  std::vector<gonio::direction_pair> poses;
  std::vector<gonio::capture::reading> white, material;

  two_scans(const std::vector<gonio::direction_pair>& pairs, const lab::surface& surface, const lab::sensor& chip,
            const lab::defects& wrong, const lab::defects& wrong_with_reference) {
    lab::dark_room with_reference(lab::white(), chip, wrong_with_reference, 1, 2);
    lab::dark_room with_material(surface, chip, wrong, 1, 3);
    Machine of_reference(with_reference), of_material(with_material);
    poses = gonio::capture::plan_scan(of_material, pairs).poses;
    white = lab::measure_all(of_reference, poses);
    material = lab::measure_all(of_material, poses);
  }
};

template <class Machine>
void check_exact(const std::vector<gonio::direction_pair>& pairs, std::size_t at_least) {
  const two_scans<Machine> scans(pairs, glossy, {}, {}, {});
  REQUIRE(scans.poses.size() >= at_least);
  REQUIRE(scans.material.size() == scans.poses.size());
  const gonio::capture::calibration known{linear_cameras, {.read = 0.0, .relative = 0.0}};
  for (std::size_t i = 0; i < scans.poses.size(); ++i) {
    const auto found = gonio::capture::measure_reflectance(scans.material[i], scans.white[i], scans.poses[i], known);
    REQUIRE(found.is_usable());
    const gonio::rgb truth = glossy(scans.poses[i].wi, scans.poses[i].wo);
    CHECK(((found.value - truth).abs() < 1e-3 * truth).all());
  }
}

}  // namespace

TEST_CASE("lab: without defects both machines measure the material itself") {
  check_exact<lab::gantry>(scattered_pairs(100, 1), 70);
  check_exact<lab::robot>(scattered_pairs(100, 1, gonio::radians(7.5)), 70);
}

TEST_CASE("lab: with the response of 20 readings, errors are as large as stated") {
  const lab::defects noise{.vignetting = 0.1, .flicker = 0.01};
  const gonio::capture::sensor_noise known{
      .read = 8.0 * 4095.0 / 20'000.0, .shot = 4095.0 / 20'000.0, .relative = 0.01};
  for (const auto curve : {lab::response_curve::linear, lab::response_curve::gamma, lab::response_curve::s_shaped}) {
    const lab::sensor chip = lab::sensor::usual(curve);
    std::vector<double> errors;  // in standard deviations
    for (unsigned seed = 1; seed <= 40; ++seed) {
      const two_scans<lab::gantry> scans(scattered_pairs(20, seed), glossy, chip, noise, noise);
      for (const auto& found : lab::calibrate(scans.material, scans.white, scans.poses, chip, known)) {
        const gonio::rgb off = found.value - glossy(found.at.wi, found.at.wo);
        if (found.is_usable())
          for (Eigen::Index c = 0; c < 3; ++c) errors.push_back(std::abs(off[c]) / found.deviation[c]);
      }
    }
    // A normal number's median size is 0.674.
    CHECK(gonio::median(errors) == doctest::Approx(0.674).epsilon(0.06));
  }
}

TEST_CASE("lab: with noise the 95 % intervals hold 90 to 99 %") {
  for (const auto curve : {lab::response_curve::linear, lab::response_curve::gamma, lab::response_curve::s_shaped}) {
    const lab::sensor chip = lab::sensor::usual(curve);
    const lab::defects noise{.vignetting = 0.1, .flicker = 0.01};
    const two_scans<lab::gantry> scans(scattered_pairs(400, 5), glossy, chip, noise, noise);
    const gonio::capture::sensor_noise known{
        .read = 8.0 * 4095.0 / 20'000.0, .shot = 4095.0 / 20'000.0, .relative = 0.01};
    std::array<double, 3> within{};
    double count = 0.0, worst = 0.0;
    for (const auto& found : lab::calibrate(scans.material, scans.white, scans.poses, chip, known)) {
      if (!found.is_usable()) continue;
      const gonio::rgb truth = glossy(found.at.wi, found.at.wo);
      const gonio::rgb off = (found.value - truth) / found.deviation;
      for (Eigen::Index c = 0; c < 3; ++c) within[c] += std::abs(off[c]) < 1.96 ? 1.0 : 0.0;
      worst = std::max(worst, ((found.value - truth) / truth).abs().maxCoeff());
      ++count;
    }
    MESSAGE("curve " << static_cast<int>(curve) << ": " << within[0] / count << " " << within[1] / count << ' '
                     << within[2] / count << " of " << count << ", worst " << worst);
    for (const double each : within) {
      CHECK(each / count >= 0.90);
      CHECK(each / count <= 0.99);
    }
  }
}
