#include <gonio/capture/device.hpp>

#include <doctest/doctest.h>

#include <numbers>

// The smallest models of the concepts, as in their documentation.
namespace {

struct torch {
  bool burns = false;
  [[nodiscard]] std::size_t lamps() const { return 1; }
  void switch_on(std::size_t) { burns = true; }
  void switch_off() { burns = false; }
};
static_assert(gonio::capture::light_source<torch>);

struct bent_wire {
  gonio::direction at = gonio::direction::UnitZ();
  [[nodiscard]] std::string obstacle(const gonio::direction& w) const { return w.z() > 0.5 ? "" : "the wire is short"; }
  void move_to(const gonio::direction& w) { at = w; }
};
static_assert(gonio::capture::positioner<bent_wire>);

/// A sensor whose green signal is a third of its red, and whose blue is zero by default.
struct photodiode {
  double red_per_second = 255.0;
  [[nodiscard]] std::uint16_t largest_count() const { return 255; }
  [[nodiscard]] double shortest_time() const { return 0.001; }
  [[nodiscard]] double longest_time() const { return 1.0; }
  [[nodiscard]] gonio::capture::camera_frame expose(double seconds) {
    gonio::capture::camera_frame counts(1, 3);
    for (Eigen::Index channel = 0; channel < 3; ++channel)
      counts(0, channel) = static_cast<std::uint16_t>(std::min(255.0, seconds * red_per_second *
                                                                          (channel == 0   ? 1.0
                                                                           : channel == 1 ? 1.0 / 3.0
                                                                                          : blue)));
    return counts;
  }
  double blue = 0.0;
};
static_assert(gonio::capture::camera<photodiode>);

struct open_hand {
  torch lamp;
  photodiode eye;
  [[nodiscard]] gonio::capture::placement place(const gonio::direction_pair& pair) const {
    return {pair, bent_wire().obstacle(pair.wo)};
  }
  [[nodiscard]] double travel(const gonio::direction_pair& from, const gonio::direction_pair& to) const {
    return gonio::angle_between(from.wo, to.wo);
  }
  [[nodiscard]] std::uint16_t largest_count() const { return eye.largest_count(); }
  [[nodiscard]] gonio::capture::reading measure(const gonio::direction_pair&) {
    return gonio::capture::expose_bracket(eye);
  }
};
static_assert(gonio::capture::goniometer<open_hand>);

}  // namespace

TEST_CASE("device: the smallest models do what the concepts say") {
  torch lamp;
  lamp.switch_on(lamp.lamps() - 1);
  CHECK(lamp.burns);
  lamp.switch_off();
  lamp.switch_off();
  CHECK(!lamp.burns);
  bent_wire wire;
  CHECK(wire.obstacle(gonio::direction::UnitX()) == "the wire is short");
  CHECK(wire.obstacle(gonio::direction::UnitZ()).empty());
  open_hand hand;
  const gonio::direction_pair low{gonio::direction::UnitZ(), gonio::spherical_direction(1.2, 0.0)};
  const gonio::direction_pair high{gonio::direction::UnitZ(), gonio::spherical_direction(0.2, 0.0)};
  CHECK(!hand.place(low).is_reachable());
  CHECK(hand.place(high).is_reachable());
  CHECK(hand.travel(low, high) == doctest::Approx(1.0));
  CHECK(hand.measure(high).frames.size() >= 5);
}

TEST_CASE("device: a bracket takes the note's times first, then others if these do not cover the range") {
  photodiode eye{.red_per_second = 1000.0, .blue = 0.3};
  const gonio::capture::reading enough = gonio::capture::expose_bracket(eye);
  CHECK(enough.times ==
        std::vector<double>(gonio::capture::note_exposure_times.begin(), gonio::capture::note_exposure_times.end()));
  CHECK(enough.frames[1](0, 0) == 25);

  eye.red_per_second = 100'000.0;  // saturates in 2.55 ms
  eye.blue = 1.0;
  const gonio::capture::reading bright = gonio::capture::expose_bracket(eye);
  CHECK(bright.times.size() == 7u);
  CHECK(bright.times[5] == doctest::Approx(0.003125));
  CHECK(bright.times.back() == 0.001);  // the camera's shortest
  CHECK(bright.frames.back()(0, 0) == 100);

  eye.red_per_second = 19'000.0;  // 237 of 255 counts in the note's shortest time
  eye.blue = 0.3;
  CHECK(gonio::capture::expose_bracket(eye).times.back() == doctest::Approx(0.003125));

  eye.red_per_second = 1000.0;
  eye.blue = 0.05;  // 10 counts in 0.2 s: this channel needs its own times
  const gonio::capture::reading dim = gonio::capture::expose_bracket(eye);
  CHECK(dim.times.size() == 6u);
  CHECK(dim.times.back() == doctest::Approx(0.8));
  CHECK(dim.frames.back()(0, 2) == 40);

  eye.blue = 0.0;  // no time is long enough
  CHECK(gonio::capture::expose_bracket(eye).times.back() == 1.0);
}

TEST_CASE("device: times outside the camera's limits are clamped") {
  photodiode eye{.red_per_second = 10.0};
  const std::vector beyond{1e-5, 20.0};
  const gonio::capture::reading taken = gonio::capture::expose_bracket(eye, beyond);
  CHECK(taken.times == std::vector{0.001, 1.0});
}
