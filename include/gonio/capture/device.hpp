#pragma once
/// What a laboratory must offer: concepts of light sources, positioners, cameras and the goniometers that are built of
/// them. The library has no drivers; examples/lab/ has models of each, which are simulations.
///
/// A call to a device blocks until the device has done what it was asked: arms are at rest, a lamp's light is steady, a
/// image is read out. What a device cannot do it says with device_failure, at once or after a time-out of its own,
/// and stays usable: whoever called may try again.

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

/// Thrown by a device that did not do what it was asked. The message names the device and what went wrong.
class device_failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Counts of the pixels that see the sample, a row for each pixel; the columns are red, green and blue.
using camera_frame = Eigen::Array<std::uint16_t, Eigen::Dynamic, 3>;

/// Images of one pair of directions.
struct reading {
  std::vector<double> times;         ///< seconds of exposure of each frame
  std::vector<camera_frame> frames;  ///< all with the same pixels
};

/// Where a goniometer would measure a pair of directions, or why it cannot.
struct placement {
  direction_pair at;     ///< in the sample's axes; not quite what was asked where lamps stand still
  std::string obstacle;  ///< empty if the machine can measure there

  [[nodiscard]] bool is_reachable() const noexcept { return obstacle.empty(); }
};

/// One lamp or several, of which one burns at a time.
///
/// A driver's author guarantees: `switch_on(lamp)`, with lamp < lamps(), returns when that lamp's light is steady and
/// all others are off; `switch_off()` may be called at any time, also twice.
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

/// An arm or a robot that brings a lamp or a camera to a direction, as seen from the sample.
///
/// A driver's author guarantees: `obstacle(w)` says in a few words why the direction w (a unit vector in the sample's
/// axes) cannot be reached, or nothing if it can, without moving; `move_to(w)` returns with the arm at rest, within the
/// machine's own precision, and throws device_failure instead of stopping half-way unnoticed; it is only called where
/// there is no obstacle.
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
/// A driver's author guarantees: `expose(seconds)`, for a time from shortest_time() to longest_time(), returns the
/// counts of the same pixels every time, from 0 to largest_count(), without gamma correction that changes from image
/// to image, automatic gain or white balance. An image that did not arrive is a device_failure.
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
/// A driver's author guarantees: `place(pair)` says where the machine would measure that pair of unit vectors, or why
/// it cannot, without moving; light and viewer hiding one another is such an obstacle. `travel(from, to)` is the
/// largest angle in radians by which a part of it turns between two pairs. `measure(pair)`, for a pair that place()
/// returned, takes images there; it leaves the lamps off, also when it throws device_failure.
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
///   std::printf("%zu poses, %g radians of way\n", plan.poses.size(), plan.length);
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

/// Takes images at some times, and at others where these do not show all: ever shorter ones while a pixel of the
/// shortest is in the uppermost eighth of the counts, where chips saturate, longer ones while a colour of the longest
/// has no count above the lowest eighth, by factors of 4 as far as the camera goes. Times beyond the camera's are
/// brought to its own. The given times come first, in their order; there is at least one.
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
  // A frame without pixels is for whoever checks the reading.
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
