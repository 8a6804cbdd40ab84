#pragma once
/// A simulated spherical gantry (Nielsen's thesis 2016, section 4.3): two arms that rotate about the sample, one with a
/// lamp, one with a camera.

#include "dark_room.hpp"

namespace lab {

/// One of the two arms. It carries its tool on a sphere about the sample.
class gantry_arm {
 public:
  using carry = void (dark_room::*)(const Eigen::Vector3d&);

  gantry_arm(dark_room& room, carry what, std::string name, double radius, double lowest)
      : room_(&room), carry_(what), name_(std::move(name)), radius_(radius), largest_polar_angle_(lowest) {}

  [[nodiscard]] std::string obstacle(const gonio::direction& w) const {
    const double theta = gonio::polar_angle(w);
    if (theta <= largest_polar_angle_) return {};
    return "the " + name_ + "'s arm reaches up to " + in_degrees(largest_polar_angle_) + ", but the direction is at " +
           in_degrees(theta);
  }
  void move_to(const gonio::direction& w) { (room_->*carry_)(radius_ * w); }

 private:
  dark_room* room_;
  carry carry_;
  std::string name_;
  double radius_, largest_polar_angle_;
};
static_assert(gonio::capture::positioner<gantry_arm>);

/// The lamp on the arm.
class gantry_lamp {
 public:
  explicit gantry_lamp(dark_room& room) : room_(&room) {}
  [[nodiscard]] Eigen::Index lamps() const { return 1; }
  void switch_on(Eigen::Index) { room_->light(true); }
  void switch_off() { room_->light(false); }

 private:
  dark_room* room_;
};
static_assert(gonio::capture::light_source<gantry_lamp>);

class gantry {
 public:
  explicit gantry(dark_room& room)
      : room_(&room),
        lamp_arm_(room, &dark_room::place_lamp, "lamp", lamp_distance, gonio::radians(85.0)),
        camera_arm_(room, &dark_room::place_camera, "camera", camera_distance, gonio::radians(85.0)),
        lamp_(room),
        camera_(room) {}

  [[nodiscard]] gonio::capture::placement place(const gonio::direction_pair& pair) const {
    std::string obstacle = lamp_arm_.obstacle(pair.wi);
    if (obstacle.empty()) obstacle = camera_arm_.obstacle(pair.wo);
    const double apart = gonio::angle_between(pair.wi, pair.wo);
    if (obstacle.empty() && apart < nearest())
      obstacle = "the camera hides the lamp if they are less than " + in_degrees(nearest()) +
                 " apart, and here they are " + in_degrees(apart) + " apart";
    return {pair, obstacle};
  }
  /// The arms move simultaneously, so the larger angle counts.
  [[nodiscard]] double travel(const gonio::direction_pair& from, const gonio::direction_pair& to) const {
    return std::max(gonio::angle_between(from.wi, to.wi), gonio::angle_between(from.wo, to.wo));
  }
  [[nodiscard]] std::uint16_t largest_count() const { return camera_.largest_count(); }

  [[nodiscard]] gonio::capture::reading measure(const gonio::direction_pair& pair) {
    room_->begin(pair);
    lamp_arm_.move_to(pair.wi);
    camera_arm_.move_to(pair.wo);
    const lit burning(lamp_, 0);
    return gonio::capture::expose_bracket(camera_);
  }

  /// Returns the tools of both arms, in the sample's axes.
  [[nodiscard]] static std::vector<carried_tool> tools() {
    return {{"camera", {.radius = camera_distance, .arc_azimuth = 0.0}, &gonio::direction_pair::wo},
            {"lamp", {.radius = lamp_distance, .arc_azimuth = 0.0}, &gonio::direction_pair::wi}};
  }

  static constexpr double lamp_distance = 1000.0, camera_distance = 600.0;

 private:
  [[nodiscard]] static double nearest() { return smallest_separation(60.0, camera_distance, 40.0, lamp_distance); }

  dark_room* room_;
  gantry_arm lamp_arm_, camera_arm_;
  gantry_lamp lamp_;
  room_camera camera_;
};
static_assert(gonio::capture::goniometer<gantry>);

}  // namespace lab
