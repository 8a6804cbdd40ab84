#pragma once
/// The interfaces of laboratory devices: concepts of light sources, positioners, cameras and the goniometers built from
/// them. The library has no drivers; examples/lab/ has simulated models of each.
///
/// A call to a device blocks until the device has finished: arms are at rest, a lamp's light is steady, an image is
/// read out. If a device cannot do what was asked, it throws device_failure, at once or after its own time-out. It then
/// stays usable, and the caller may retry.

#include <gonio/core/direction.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace gonio::capture {

/// Thrown by a device that did not do what was asked. The message names the device and the problem.
class device_failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Counts of the pixels that see the sample: one row per pixel; columns red, green and blue.
using camera_frame = Eigen::Array<std::uint16_t, Eigen::Dynamic, 3>;

/// Images taken at one pair of directions, with different exposure times.
struct reading {
  std::vector<double> times;         ///< seconds of exposure of each frame
  std::vector<camera_frame> frames;  ///< all with the same pixels
};

/// The pair at which a goniometer would measure a requested pair, or the reason why it cannot.
struct placement {
  direction_pair at;     ///< in the sample's axes; may differ slightly from the request if lamps are fixed
  std::string obstacle;  ///< empty if the machine can measure there

  [[nodiscard]] bool is_reachable() const noexcept { return obstacle.empty(); }
};

/// One or several lamps, of which at most one is on.
///
/// The driver must guarantee: `switch_on(lamp)`, with lamp < lamps(), returns when that lamp's light is steady and all
/// other lamps are off. `switch_off()` may be called at any time, also twice.
/// ```cpp
/// struct torch {
///   Eigen::Index lamps() const { return 1; }
///   void switch_on(Eigen::Index) {}
///   void switch_off() {}
/// };
/// static_assert(gonio::capture::light_source<torch>);
/// ```
template <class L>
concept light_source = requires(L& lights, const L& same, Eigen::Index lamp) {
  { same.lamps() } -> std::convertible_to<Eigen::Index>;
  lights.switch_on(lamp);
  lights.switch_off();
};

/// An arm or a robot that moves a lamp or a camera to a direction, as seen from the sample.
///
/// The driver must guarantee: `obstacle(w)` does not move the arm and returns a short reason why the direction w (a
/// unit vector in the sample's axes) cannot be reached, or an empty string if it can. `move_to(w)` returns with the arm
/// at rest, within the machine's own precision, and throws device_failure if it stops half-way. It is only called for
/// directions without an obstacle.
/// ```cpp
/// struct bent_wire {
///   std::string obstacle(const gonio::direction& w) const { return w.z() > 0.5 ? "" : "the wire is too short"; }
///   void move_to(const gonio::direction&) {}
/// };
/// static_assert(gonio::capture::positioner<bent_wire>);
/// ```
template <class P>
concept positioner = requires(P& arm, const P& same, const direction& w) {
  { same.obstacle(w) } -> std::convertible_to<std::string>;
  arm.move_to(w);
};

/// A camera that looks at the sample.
///
/// The driver must guarantee: `expose(seconds)`, for a time from shortest_time() to longest_time(), returns the counts
/// of the same pixels every time, from 0 to largest_count(). It uses no gamma correction that changes between images,
/// no automatic gain and no white balance. It throws device_failure if an image does not arrive.
/// ```cpp
/// struct photodiode {
///   std::uint16_t largest_count() const { return 255; }
///   double shortest_time() const { return 0.001; }
///   double longest_time() const { return 1.0; }
///   gonio::capture::camera_frame expose(double seconds) {
///     return gonio::capture::camera_frame::Constant(1, 3, static_cast<std::uint16_t>(255 * seconds));
///   }
/// };
/// static_assert(gonio::capture::camera<photodiode>);
/// ```
template <class C>
concept camera = requires(C& eye, const C& same, double seconds) {
  { same.largest_count() } -> std::convertible_to<std::uint16_t>;
  { same.shortest_time() } -> std::convertible_to<double>;
  { same.longest_time() } -> std::convertible_to<double>;
  { eye.expose(seconds) } -> std::convertible_to<camera_frame>;
};

/// A machine that measures pairs of directions.
///
/// The driver must guarantee: `place(pair)` does not move the machine and returns the pair of unit vectors at which it
/// would measure, or the reason why it cannot, such as light and viewer occluding each other. `travel(from, to)` is the
/// largest angle in radians by which a part of the machine turns between two pairs. `measure(pair)` takes images at a
/// pair that place() returned. It leaves the lamps off, even when it throws device_failure.
///
/// With a machine of your own; examples/lab has simulated ones:
/// ```cpp
/// #include <gonio/capture/scan.hpp>
///
/// #include <cstdio>
///
/// struct open_hand {
///   gonio::capture::placement place(const gonio::direction_pair& pair) const { return {pair, ""}; }
///   double travel(const gonio::direction_pair& from, const gonio::direction_pair& to) const {
///     return gonio::angle_between(from.wi, to.wi);
///   }
///   std::uint16_t largest_count() const { return 255; }
///   gonio::capture::reading measure(const gonio::direction_pair&) {
///     return {{0.1}, {gonio::capture::camera_frame::Constant(1, 3, 7)}};
///   }
/// };
/// static_assert(gonio::capture::goniometer<open_hand>);
///
/// int main() {
///   const std::vector<gonio::direction_pair> pairs{{{0, 0, 1}, {0, 0, 1}}, {{0.6, 0, 0.8}, {0, 0, 1}}};
///   const gonio::capture::scan_plan plan = gonio::capture::plan_scan(open_hand{}, pairs);
///   std::printf("%zu poses, %g radians of travel\n", plan.poses.size(), plan.length);
/// }
/// ```
template <class G>
concept goniometer = requires(G& machine, const G& same, const direction_pair& pair) {
  { same.place(pair) } -> std::convertible_to<placement>;
  { same.travel(pair, pair) } -> std::convertible_to<double>;
  { same.largest_count() } -> std::convertible_to<std::uint16_t>;
  { machine.measure(pair) } -> std::convertible_to<reading>;
};

/// The exposure times of the thesis's note on relative BRDF measurement (Sec. 3), in seconds.
inline constexpr std::array<double, 5> note_exposure_times{0.0125, 0.025, 0.05, 0.1, 0.2};

/// Takes images at the given times, and at further times if the given times do not cover the range of the scene. Adds
/// shorter exposures while a pixel of the shortest exposure is in the top eighth of the counts, where chips saturate.
/// Adds longer exposures while a colour of the longest exposure has no count above the lowest eighth. Each added time
/// differs by a factor of 4 from the one before, within the camera's limits. Given times outside the limits are
/// clamped. The given times come first, in their order; there must be at least one.
template <camera Camera>
[[nodiscard]] reading expose_bracket(Camera& eye, std::span<const double> times = note_exposure_times) {
  constexpr double factor = 4.0;
  const std::uint16_t largest = eye.largest_count();
  const double shortest = eye.shortest_time(), longest = eye.longest_time();
  reading taken;
  const auto expose = [&](double time) {
    taken.times.push_back(std::clamp(time, shortest, longest));
    taken.frames.push_back(eye.expose(taken.times.back()));
  };
  for (const double time : times) expose(time);
  const auto [least, most] = std::ranges::minmax_element(taken.times);
  const Eigen::Index darkest = least - taken.times.begin();
  const Eigen::Index brightest = most - taken.times.begin();
  // The caller checks for frames without pixels.
  const auto is_bright = [&](const camera_frame& each) {
    return each.rows() > 0 && each.maxCoeff() >= largest - largest / 8;
  };
  const auto is_dim = [&](const camera_frame& each) {
    return each.rows() > 0 && each.colwise().maxCoeff().minCoeff() < largest / 8;
  };
  for (auto at = darkest; is_bright(taken.frames[at]) && taken.times[at] > shortest; at = taken.frames.size() - 1)
    expose(taken.times[at] / factor);
  for (auto at = brightest; is_dim(taken.frames[at]) && taken.times[at] < longest; at = taken.frames.size() - 1)
    expose(taken.times[at] * factor);
  return taken;
}

}  // namespace gonio::capture
