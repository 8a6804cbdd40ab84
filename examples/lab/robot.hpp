#pragma once
/// A simulated robot that carries a camera about a sample under an arc of fixed lamps (Nielsen's thesis 2016, note on
/// the gonioreflectometer).

#include "dark_room.hpp"
#include <gonio/capture/trajectory.hpp>

namespace lab {

/// The arc of lamps: one lamp every 7.5 degrees, at 1000 mm from the sample. One lamp at a time is on.
class lamp_arc {
 public:
  explicit lamp_arc(dark_room& room) : room_(&room), towards_(gonio::capture::arc_lamps()) {}

  [[nodiscard]] Eigen::Index lamps() const { return towards_.size(); }
  void switch_on(Eigen::Index lamp) {
    room_->place_lamp(radius * towards_.at(lamp));
    room_->light(true);
  }
  void switch_off() { room_->light(false); }

  /// Returns the direction towards a lamp, in the sample's axes. The arc lies above the x axis.
  [[nodiscard]] const gonio::direction& towards(Eigen::Index lamp) const { return towards_[lamp]; }
  [[nodiscard]] Eigen::Index nearest(const gonio::direction& w) const {
    const auto off = [&](const gonio::direction& lamp) { return gonio::angle_between(lamp, w); };
    return std::ranges::min_element(towards_, {}, off) - towards_.begin();
  }

  static constexpr double radius = 1000.0;

 private:
  dark_room* room_;
  std::vector<gonio::direction> towards_;
};
static_assert(gonio::capture::light_source<lamp_arc>);

/// The six-axis robot with the camera in its hand. Its commands are positions and quaternions in its own axes, in which
/// the arc lies above the y axis.
class robot_arm {
 public:
  explicit robot_arm(dark_room& room) : room_(&room) {}

  [[nodiscard]] std::string obstacle(const gonio::direction& w) const {
    if (gonio::polar_angle(w) <= lowest) return {};
    return "the robot would touch the table below " + in_degrees(lowest) + ", and this direction is at " +
           in_degrees(gonio::polar_angle(w));
  }
  void move_to(const gonio::direction& w) { obey(sphere_.towards(w)); }

  [[nodiscard]] const gonio::capture::camera_sphere& sphere() const { return sphere_; }

 private:
  /// Acts like the robot's controller: moves to the commanded pose. Throws if the camera does not look at the sample.
  void obey(const gonio::capture::camera_pose& pose) {
    const gonio::direction to_sample = (sphere_.centre - pose.position).normalized();
    if (gonio::angle_between(pose.looks_along(), to_sample) > gonio::radians(0.01))
      throw gonio::capture::device_failure("the robot's camera does not look at the sample");
    room_->place_camera(sphere_.radius * sphere_.seen_from(pose));
  }

  static constexpr double lowest = 83.0 * std::numbers::pi / 180.0;

  dark_room* room_;
  gonio::capture::camera_sphere sphere_;
};
static_assert(gonio::capture::positioner<robot_arm>);

/// Robot and arc. A direction of the light is unreachable if the nearest lamp is more than `tolerance` away; otherwise
/// the pair is measured with that lamp.
class robot {
 public:
  explicit robot(dark_room& room, double tolerance = gonio::radians(0.5))
      : room_(&room), arc_(room), arm_(room), camera_(room), tolerance_(tolerance) {}

  [[nodiscard]] gonio::capture::placement place(const gonio::direction_pair& pair) const {
    const bool is_above = std::abs(pair.wi.y()) < 1e-9 && pair.wo.y() > -1e-9;
    const gonio::direction_pair turned = is_above ? pair : gonio::capture::above_arc(pair);
    const gonio::direction lamp = arc_.towards(arc_.nearest(turned.wi));
    const gonio::capture::placement at{{lamp, turned.wo}, arm_.obstacle(turned.wo)};
    if (!at.is_reachable()) return at;
    const double off = gonio::angle_between(lamp, turned.wi), apart = gonio::angle_between(lamp, turned.wo);
    if (off > tolerance_ + 1e-9)
      return {at.at, "the nearest lamp is " + in_degrees(off) + " away, allowed are " + in_degrees(tolerance_)};
    if (apart < nearest())
      return {at.at, "the camera hides the lamp if they are less than " + in_degrees(nearest()) +
                         " apart, and here they are " + in_degrees(apart) + " apart"};
    return at;
  }
  /// Only the camera moves, so the light does not count.
  [[nodiscard]] double travel(const gonio::direction_pair& from, const gonio::direction_pair& to) const {
    return gonio::angle_between(from.wo, to.wo);
  }
  [[nodiscard]] std::uint16_t largest_count() const { return camera_.largest_count(); }
  [[nodiscard]] const lamp_arc& arc() const { return arc_; }

  /// Returns the camera in the robot's hand, in the robot's axes.
  [[nodiscard]] std::vector<carried_tool> tools() const {
    return {{"camera", arm_.sphere(), &gonio::direction_pair::wo}};
  }

  [[nodiscard]] gonio::capture::reading measure(const gonio::direction_pair& pair) {
    room_->begin(pair);
    arm_.move_to(pair.wo);
    const lit burning(arc_, arc_.nearest(pair.wi));
    return gonio::capture::expose_bracket(camera_);
  }

 private:
  [[nodiscard]] double nearest() const {
    return smallest_separation(30.0, arm_.sphere().radius, 20.0, lamp_arc::radius);
  }

  dark_room* room_;
  lamp_arc arc_;
  robot_arm arm_;
  room_camera camera_;
  double tolerance_;
};
static_assert(gonio::capture::goniometer<robot>);

}  // namespace lab
