#pragma once
/// Choice of the simulated laboratory's machine.

#include "command.hpp"
#include "lab/gantry.hpp"
#include "lab/robot.hpp"
#include "tool/pages/fixed.hpp"

#include <string>

namespace cli {

/// The machine in the laboratory.
struct machine_choice {
  std::string name = "gantry";
  double tolerance = 0.5;  ///< robot: largest angle to its nearest lamp, degrees
};

/// Adds `--machine` and `--lamp-tolerance`.
inline void add_machine_options(command& to, machine_choice& machine) {
  to.add_option(
        "--machine", machine.name,
        "Machine: gantry, two arms for lamp and camera; or robot, a camera under an arc of lamps every 7.5 degrees")
      .check(check::one_of({"gantry", "robot"}))
      .capture_default_str();
  to.add_option("--lamp-tolerance", machine.tolerance,
                "With --machine robot: largest angle between a direction and the lamp used for it, in degrees")
      .check(check::range(0.0, 90.0))
      .capture_default_str();
}

/// Calls `use(machine)` with the chosen machine in a room.
template <class Use>
auto with_machine(const machine_choice& choice, lab::dark_room& room, Use&& use) {
  if (choice.name == "robot") {
    lab::robot machine(room, gonio::radians(choice.tolerance));
    return use(machine);
  }
  lab::gantry machine(room);
  return use(machine);
}

/// Returns a pair of directions as text for people.
[[nodiscard]] inline std::string in_degrees(const gonio::direction_pair& pair) {
  const auto angles = [](const gonio::direction& w) {
    return fixed(gonio::degrees(gonio::polar_angle(w)), 1) + ", " + fixed(gonio::degrees(gonio::azimuth(w)), 1);
  };
  return "light at " + angles(pair.wi) + ", viewer at " + angles(pair.wo);
}

}  // namespace cli
