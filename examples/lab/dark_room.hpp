#pragma once
/// A simulated laboratory: a flat sample in a dark room, a lamp, a camera, and their defects. The machines that move
/// lamp and camera are in gantry.hpp and robot.hpp. Lengths are in mm.

#include "random_turn.hpp"
#include <gonio/capture/device.hpp>
#include <gonio/capture/reference_reflectance.hpp>
#include <gonio/capture/trajectory.hpp>
#include <gonio/core/rgb.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace lab {

/// The defects. By default there are none.
struct defects {
  double misalignment = 0.0;  ///< radians by which lamps, camera and sample are rotated, each about its own axis
  double lamp_radius = 0.0;   ///< mm; the lamp is a disc that faces the sample
  double field = 0.0;         ///< mm from the centre of the sample to the edge of the camera's field of view
  double vignetting = 0.0;    ///< fraction of the light that is lost in the image's corners
  double stray = 0.0;         ///< light from the room's walls, as a fraction of the light from a white sample
  double flicker = 0.0;       ///< relative standard deviation of each exposure, from lamp and shutter
  double outliers = 0.0;      ///< fraction of the poses at which the light is wrong by a factor from 0.1 to 10

  /// The defects of a well-kept laboratory.
  [[nodiscard]] static defects usual() {
    return {.misalignment = gonio::radians(0.5),
            .lamp_radius = 5.0,
            .field = 2.0,
            .vignetting = 0.1,
            .stray = 1e-4,
            .flicker = 0.01};
  }
};

/// The camera's response: the fraction of the largest count as a function of the fraction of the saturating exposure.
enum class response_curve { linear, gamma, s_shaped };

[[nodiscard]] inline double count_share(response_curve curve, double exposure) {
  const double x = std::clamp(exposure, 0.0, 1.0);
  switch (curve) {
    case response_curve::gamma:
      return std::pow(x, 1.0 / 2.2);
    case response_curve::s_shaped:  // a toe and a shoulder on a logarithmic scale
      return 1.25 * std::pow(x, 1.2) / (std::pow(x, 1.2) + 0.25);
    case response_curve::linear:
      break;
  }
  return x;
}

/// The camera's sensor. By default it adds no noise except rounding to whole counts.
struct sensor {
  std::uint16_t largest_count = 65535;
  response_curve curve = response_curve::linear;
  double full_well = std::numeric_limits<double>::infinity();  ///< electrons at saturation, for shot noise
  double read_noise = 0.0;                                     ///< electrons
  /// Exposure in seconds at which a white sample saturates the sensor, with the lamp at the normal.
  double saturating = 0.04;
  int side = 8;  ///< pixels in each direction that see the sample
  double shortest_time = 10e-6, longest_time = 10.0;

  /// A 12-bit camera.
  [[nodiscard]] static sensor usual(response_curve curve = response_curve::linear) {
    return {.largest_count = 4095, .curve = curve, .full_well = 20'000.0, .read_noise = 8.0};
  }
};

/// f(wi, wo) of the sample in the centre of the room.
using surface = std::function<gonio::rgb(const gonio::direction& wi, const gonio::direction& wo)>;

/// The white reference.
[[nodiscard]] inline surface white(const gonio::capture::reference_reflectance& reflectance = 0.99) {
  return [=](const gonio::direction& wi, const gonio::direction& wo) -> gonio::rgb {
    if (wi.z() <= 0.0 || wo.z() <= 0.0) return gonio::rgb::Zero();
    return reflectance.at({wi, wo}) * std::numbers::inv_pi;
  };
}

/// The solid angle in sr of the machines' lamps, seen from the sample: a disc of this radius at this distance, in mm.
[[nodiscard]] inline double lamp_solid_angle(double radius = 5.0, double distance = 1000.0) {
  return std::numbers::pi * radius * radius / (distance * distance);
}

/// The lamp itself, for a camera that looks into it through a filter. The irradiance E cos(theta_i) of a lamp of this
/// solid angle comes from the radiance E / solid_angle.
[[nodiscard]] inline surface lamp_through(double transmittance, double solid_angle = lamp_solid_angle()) {
  return [=](const gonio::direction& wi, const gonio::direction&) -> gonio::rgb {
    if (wi.z() <= 0.0) return gonio::rgb::Zero();
    return gonio::rgb::Constant(transmittance / (solid_angle * wi.z()));
  };
}

/// The positions of all devices, and the camera's counts. All random numbers come from seeds: the room's seed gives the
/// misalignment of lamps and camera, the sample's seed the misalignment of the sample, and the sample's seed with a
/// pose the noise of that pose. A resumed scan therefore reads the same counts as an uninterrupted one.
class dark_room {
 public:
  dark_room(surface sample, const sensor& chip, const defects& wrong, std::uint64_t room_seed = 0,
            std::uint64_t sample_seed = 0)
      : sample_(std::move(sample)), chip_(chip), wrong_(wrong), seed_(sample_seed) {
    std::mt19937_64 of_room(room_seed), of_sample(sample_seed);
    turn_lamp_ = random_turn(wrong.misalignment, of_room);
    turn_camera_ = random_turn(wrong.misalignment, of_room);
    turn_sample_ = random_turn(wrong.misalignment, of_sample);
  }

  [[nodiscard]] const sensor& chip() const noexcept { return chip_; }

  /// Seeds the random numbers for this pose.
  void begin(const gonio::direction_pair& pose) {
    std::vector<std::int64_t> parts{static_cast<std::int64_t>(seed_)};
    for (const gonio::direction& w : {pose.wi, pose.wo})
      for (const double component : w) parts.push_back(std::llround(1e6 * component));
    std::seed_seq seeds(parts.begin(), parts.end());
    generator_.seed(seeds);
    normal_.reset();
    std::uniform_real_distribution<double> uniform;
    const bool is_outlier = uniform(generator_) < wrong_.outliers;
    const double exponent = 2.0 * uniform(generator_) - 1.0;
    factor_ = is_outlier ? std::pow(10.0, exponent) : 1.0;
  }

  void place_lamp(const Eigen::Vector3d& position) { lamp_ = position; }
  void place_camera(const Eigen::Vector3d& position) { camera_ = position; }
  void light(bool is_on) { is_lit_ = is_on; }

  [[nodiscard]] gonio::capture::camera_frame expose(double seconds) {
    const double exposed = seconds / chip_.saturating * (1.0 + wrong_.flicker * normal_(generator_));
    gonio::capture::camera_frame counts(chip_.side * chip_.side, 3);
    for (int row = 0; row < chip_.side; ++row)
      for (int column = 0; column < chip_.side; ++column) {
        // Position in the image, from -1 to 1.
        const double x = (2.0 * column + 1.0) / chip_.side - 1.0, y = (2.0 * row + 1.0) / chip_.side - 1.0;
        const double vignette = 1.0 - wrong_.vignetting * (x * x + y * y) / 2.0;
        const gonio::rgb light = is_lit_ ? gonio::rgb(vignette * radiance(x, y)) : gonio::rgb::Zero();
        for (Eigen::Index channel = 0; channel < 3; ++channel)
          counts(row * chip_.side + column, channel) = count(light[channel] * std::numbers::pi * exposed);
      }
    return counts;
  }

 private:
  /// Returns the radiance at an image position: 1 / pi for white if the lamp is at the normal, at its usual distance.
  [[nodiscard]] gonio::rgb radiance(double x, double y) const {
    // In the sample's own axes, with all misalignments undone.
    const Eigen::Vector3d camera = turn_sample_.transpose() * turn_camera_ * camera_;
    const Eigen::Vector3d lamp = turn_sample_.transpose() * turn_lamp_ * lamp_;
    const Eigen::Vector3d point = seen_point(camera, wrong_.field * x, wrong_.field * y);
    const gonio::direction wo = (camera - point).normalized();

    gonio::rgb sum = gonio::rgb::Zero();
    double white_sum = 0.0;
    for (const Eigen::Vector3d& source : lamp_points(lamp)) {
      const Eigen::Vector3d way = source - point;
      const gonio::direction wi = way.normalized();
      const double irradiance = std::max(wi.z(), 0.0) * lamp_.squaredNorm() / way.squaredNorm() / lamp_samples();
      sum += sample_(wi, wo) * irradiance;
      white_sum += irradiance;
    }
    return factor_ * sum + wrong_.stray * white_sum * std::numbers::inv_pi;
  }

  /// Returns the sample point behind a position in the plane through the sample's centre and perpendicular to the view.
  [[nodiscard]] static Eigen::Vector3d seen_point(const Eigen::Vector3d& camera, double x, double y) {
    if (x == 0.0 && y == 0.0) return Eigen::Vector3d::Zero();
    const Eigen::Vector3d right = camera.unitOrthogonal();
    const Eigen::Vector3d target = x * right + y * camera.normalized().cross(right);
    const double reach = camera.z() / (camera.z() - target.z());
    return camera + reach * (target - camera);
  }

  [[nodiscard]] double lamp_samples() const { return wrong_.lamp_radius > 0.0 ? 1.0 + ring : 1.0; }

  /// Returns points that represent the lamp: its centre and a ring. Their mean squared distance from the centre equals
  /// the disc's.
  [[nodiscard]] std::vector<Eigen::Vector3d> lamp_points(const Eigen::Vector3d& lamp) const {
    std::vector<Eigen::Vector3d> points{lamp};
    if (!(wrong_.lamp_radius > 0.0)) return points;
    const Eigen::Vector3d right = lamp.unitOrthogonal(), up = lamp.normalized().cross(right);
    const double radius = wrong_.lamp_radius * std::sqrt((1.0 + ring) / (2.0 * ring));
    for (int i = 0; i < ring; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / ring;
      points.emplace_back(lamp + radius * (std::cos(angle) * right + std::sin(angle) * up));
    }
    return points;
  }

  /// Returns the count for an exposure relative to the saturating one.
  [[nodiscard]] std::uint16_t count(double exposure) {
    double share = exposure;
    if (std::isfinite(chip_.full_well)) {
      const double electrons = std::max(exposure, 0.0) * chip_.full_well;
      const double deviation = std::sqrt(electrons + chip_.read_noise * chip_.read_noise);
      share = (electrons + deviation * normal_(generator_)) / chip_.full_well;
    }
    return static_cast<std::uint16_t>(std::lround(chip_.largest_count * count_share(chip_.curve, share)));
  }

  static constexpr int ring = 6;

  surface sample_;
  sensor chip_;
  defects wrong_;
  std::uint64_t seed_;
  Eigen::Matrix3d turn_lamp_, turn_camera_, turn_sample_;
  Eigen::Vector3d lamp_{0.0, 0.0, 1000.0}, camera_{0.0, 0.0, 350.0};
  bool is_lit_ = false;
  double factor_ = 1.0;
  std::mt19937_64 generator_;
  std::normal_distribution<double> normal_;
};

/// The room's camera.
class room_camera {
 public:
  explicit room_camera(dark_room& room) : room_(&room) {}

  [[nodiscard]] std::uint16_t largest_count() const { return room_->chip().largest_count; }
  [[nodiscard]] double shortest_time() const { return room_->chip().shortest_time; }
  [[nodiscard]] double longest_time() const { return room_->chip().longest_time; }
  [[nodiscard]] gonio::capture::camera_frame expose(double seconds) {
    if (!(seconds >= shortest_time() && seconds <= longest_time()))
      throw gonio::capture::device_failure("the camera does not expose for " + std::to_string(seconds) + " s");
    return room_->expose(seconds);
  }

 private:
  dark_room* room_;
};
static_assert(gonio::capture::camera<room_camera>);

/// A tool that a machine carries on a sphere about the sample, always pointed at it.
struct carried_tool {
  std::string name;
  gonio::capture::camera_sphere sphere;                   ///< in the machine's axes
  gonio::direction gonio::direction_pair::*towards = {};  ///< the direction that the tool follows, wi or wo
};

/// Switches a lamp on, and off again even after an exception.
template <gonio::capture::light_source Lights>
class lit {
 public:
  lit(Lights& lights, Eigen::Index lamp) : lights_(lights) { lights_.switch_on(lamp); }
  lit(const lit&) = delete;
  lit& operator=(const lit&) = delete;
  ~lit() { lights_.switch_off(); }

 private:
  Lights& lights_;
};

/// Returns the smallest angle between two objects, seen from the sample, at which the nearer object does not cover the
/// farther one, given the radius and the distance of each.
[[nodiscard]] inline double smallest_separation(double near_radius, double near_distance, double far_radius,
                                                double far_distance) {
  return std::asin(near_radius / near_distance) + std::asin(far_radius / far_distance);
}

[[nodiscard]] inline std::string in_degrees(double angle) {
  std::string text = std::to_string(gonio::degrees(angle));
  return text.substr(0, text.find('.') + 2) + " degrees";
}

}  // namespace lab
