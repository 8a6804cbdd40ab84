/// gonio lab plan: which directions a machine can measure, in which order, and how long that takes.

#include "command_line/fixed.hpp"
#include "command_line/machine_choice.hpp"
#include "lab.hpp"
#include <gonio/capture/scan.hpp>
#include <gonio/io/samples.hpp>

#include <iostream>
#include <memory>

namespace cli {

namespace {

struct plan_command {
  std::filesystem::path directions, output;
  machine_choice machine;
  bool whole = false;
};

/// A plan, and how many lamps burn one after the other at each stop.
struct timed_plan {
  gonio::capture::scan_plan plan;
  Eigen::Index stops = 0, lamps = 1;
};

/// The note's whole scan: the camera at every pose of the half hemisphere, under every lamp.
timed_plan whole_hemisphere(const lab::robot& machine) {
  const auto seen = gonio::capture::half_hemisphere();
  const auto order = gonio::capture::short_way(seen);
  timed_plan result{{}, std::ssize(seen), machine.arc().lamps()};
  result.plan.length = gonio::capture::length_of_way(seen, order);
  Eigen::Index number = 0;
  for (const Eigen::Index i : order)
    for (Eigen::Index lamp = 0; lamp < machine.arc().lamps(); ++lamp, ++number) {
      const gonio::capture::placement found = machine.place({machine.arc().towards(lamp), seen[i]});
      if (found.is_reachable())
        result.plan.poses.push_back(found.at);
      else
        result.plan.unreachable.push_back({number, found.obstacle});
    }
  return result;
}

timed_plan plan_of(const plan_command& options) {
  lab::dark_room room(lab::white(), {}, {});
  if (options.whole) {
    if (options.machine.name != "robot") gonio::refuse("--whole requires --machine robot");
    return whole_hemisphere(lab::robot(room, gonio::radians(options.machine.tolerance)));
  }
  const auto pairs = gonio::io::read_direction_pairs(options.directions);
  timed_plan result;
  result.plan = with_machine(options.machine, room,
                             [&](const auto& machine) { return gonio::capture::plan_scan(machine, pairs); });
  for (const auto& [number, reason] : result.plan.unreachable)
    std::cout << "not measured: " << number + 1 << ", " << in_degrees(pairs[number]) << ": " << reason << '\n';
  result.stops = result.plan.poses.size();
  return result;
}

void run(const plan_command& options) {
  const auto [plan, stops, lamps] = plan_of(options);
  if (plan.poses.empty()) gonio::refuse("the machine can measure none of the directions");
  gonio::io::write_direction_pairs(options.output, plan.poses);
  const double minutes = gonio::capture::duration_of_scan(plan.length, stops, lamps) / 60.0;
  std::cout << plan.poses.size() << " poses, " << plan.unreachable.size() << " cannot be reached; the way is "
            << fixed(gonio::degrees(plan.length), 0) << " degrees long, and a scan takes about " << fixed(minutes, 1)
            << " minutes\n";
}

}  // namespace

void add_lab_plan(command& lab) {
  auto command = lab.add_subcommand("plan", "Directions as poses of a machine, in the order of a short way");
  const auto options = std::make_shared<plan_command>();
  auto what = command.add_option_group("what", "What to measure (one of)");
  what.add_input("directions", options->directions, "Directions, as `gonio design` writes them (.csv)");
  what.add_flag("--whole", options->whole,
                "Every camera pose of the half hemisphere under every lamp of the robot's arc");
  what.require_option(1);
  add_machine_options(command, options->machine);
  command.add_output("-o,--output", options->output, {".csv"}, "Poses to write (.csv)").required();
  command.callback([options] { run(*options); });
}

}  // namespace cli
