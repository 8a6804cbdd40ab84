#include "synthetic_machine.hpp"

#include <doctest/doctest.h>

#include <stdexcept>

using gonio::direction_pair;
using gonio::spherical_direction;

TEST_CASE("scan: a plan is a short path through the reachable pairs, and names the others") {
  std::vector<direction_pair> pairs = synthetic_poses(12);
  pairs.push_back({spherical_direction(1.3, 0.0), spherical_direction(0.2, 1.0)});  // reachable by reciprocity
  pairs.push_back({spherical_direction(1.3, 0.0), spherical_direction(1.3, 1.0)});  // unreachable
  const synthetic_machine machine;
  const gonio::capture::scan_plan plan = gonio::capture::plan_scan(machine, pairs);
  CHECK(plan.poses.size() == 13u);
  REQUIRE(plan.unreachable.size() == 1u);
  CHECK(plan.unreachable[0].number == 13u);
  CHECK(plan.unreachable[0].reason == "the lamp is too low");
  double as_given = 0.0, as_planned = 0.0;
  for (std::size_t i = 1; i < 12; ++i) as_given += machine.travel(pairs[i - 1], pairs[i]);
  for (std::size_t i = 1; i < 13; ++i) as_planned += machine.travel(plan.poses[i - 1], plan.poses[i]);
  CHECK(plan.length == doctest::Approx(as_planned));
  CHECK(as_planned < as_given);
  for (const direction_pair& pose : plan.poses) CHECK(machine.place(pose).is_reachable());
}

TEST_CASE("scan: stored poses are not measured again") {
  synthetic_machine machine;
  synthetic_record record;
  const auto poses = synthetic_poses(5);
  record.add(1, {});
  record.add(4, {});
  const auto outcome = gonio::capture::scan(machine, poses, record);
  CHECK(outcome.measured == 3u);
  CHECK(outcome.kept_before == 2u);
  CHECK(outcome.is_complete());
  CHECK(machine.measured.size() == 3u);
  CHECK(record.kept.size() == 5u);
  CHECK(gonio::capture::scan(machine, poses, record).kept_before == 5u);
  CHECK(machine.measured.size() == 3u);
}

TEST_CASE("scan: a device that fails once is tried again; a pose that fails twice is left to the next scan") {
  synthetic_machine machine;
  synthetic_record record;
  int calls = 0;
  machine.fault = [&](gonio::capture::reading&) {
    ++calls;
    if (calls == 2 || calls == 4 || calls == 5) throw gonio::capture::device_failure("the shutter is stuck");
  };
  const auto outcome = gonio::capture::scan(machine, synthetic_poses(5), record);
  CHECK(outcome.measured == 4u);
  REQUIRE(outcome.missing.size() == 1u);
  CHECK(outcome.missing[0].number == 2u);
  CHECK(outcome.missing[0].reason == "the shutter is stuck");
  CHECK(!outcome.is_broken_off);
  CHECK(!outcome.is_complete());
  machine.fault = [](gonio::capture::reading&) {};
  CHECK(gonio::capture::scan(machine, synthetic_poses(5), record).measured == 1u);
}

TEST_CASE("scan: a scan of a machine that keeps failing stops, and stored readings are kept") {
  synthetic_machine machine;
  synthetic_record record;
  machine.fault = [&](gonio::capture::reading&) {
    if (machine.measured.size() > 2) throw gonio::capture::device_failure("no power");
  };
  const auto outcome = gonio::capture::scan(machine, synthetic_poses(20), record);
  CHECK(outcome.measured == 2u);
  CHECK(outcome.missing.size() == 3u);
  CHECK(outcome.is_broken_off);
  CHECK(!outcome.is_complete());
  CHECK(record.kept.size() == 2u);
}

TEST_CASE("scan: other exceptions propagate, and stored readings are kept") {
  synthetic_machine machine;
  synthetic_record record;
  machine.fault = [&](gonio::capture::reading&) {
    if (machine.measured.size() == 3) throw std::logic_error("a bug in the driver");
  };
  CHECK_THROWS_AS(gonio::capture::scan(machine, synthetic_poses(5), record), std::logic_error);
  CHECK(record.kept.size() == 2u);
}

TEST_CASE("scan: faulty readings are not stored") {
  using change = std::function<void(gonio::capture::reading&)>;
  const std::vector<std::pair<change, std::string>> faults{
      {[](gonio::capture::reading& taken) { taken = {}; }, "no frame"},
      {[](gonio::capture::reading& taken) { taken.frames.pop_back(); }, "1 frames for 2 exposures"},
      {[](gonio::capture::reading& taken) { taken.frames[1] = gonio::capture::camera_frame::Constant(1, 3, 5); },
       "a frame has 1 pixels, the first 2"},
      {[](gonio::capture::reading& taken) { taken.frames[0](1, 2) = 101; }, "101 counts"}};
  for (const auto& [fault, message] : faults) {
    synthetic_machine machine{fault};
    synthetic_record record;
    const auto outcome = gonio::capture::scan(machine, synthetic_poses(1), record);
    CHECK(record.kept.empty());
    REQUIRE(outcome.missing.size() == 1u);
    CHECK(outcome.missing[0].reason.find(message) != std::string::npos);
    CHECK(machine.measured.size() == 2u);
  }
}

TEST_CASE("scan: a pose that cannot be reached is missing, and the machine does not move") {
  synthetic_machine machine;
  synthetic_record record;
  std::vector<direction_pair> poses = synthetic_poses(3);
  poses[1].wi = spherical_direction(1.3, 0.0);
  const auto outcome = gonio::capture::scan(machine, poses, record);
  CHECK(outcome.measured == 2u);
  REQUIRE(outcome.missing.size() == 1u);
  CHECK(outcome.missing[0].reason == "the lamp is too low");
  CHECK(machine.measured.size() == 2u);
}
