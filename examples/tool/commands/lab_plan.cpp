/// gonio lab plan: plans which directions a machine can measure, their order, and the duration.

#include "lab.hpp"
#include "tool/files/measurement_files.hpp"
#include "tool/options/machine_choice.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/pages/fixed.hpp"
#include <gonio/capture/scan.hpp>
#include <gonio/capture/trajectory.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/io/text/text.hpp>

#include <cmath>
#include <iostream>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace cli {

namespace {

struct plan_command {
  std::filesystem::path directions, output, poses;
  machine_choice machine;
  bool whole = false;
};

/// A plan, and the number of lamps that are switched on in turn at each stop.
struct timed_plan {
  gonio::capture::scan_plan plan;
  Eigen::Index stops = 0, lamps = 1;
};

/// Returns the complete scan: the camera at every pose of the half hemisphere, under every lamp.
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
    if (options.machine.name != "robot") gonio::refuse("--whole needs --machine robot");
    return whole_hemisphere(lab::robot(room, gonio::radians(options.machine.tolerance)));
  }
  const auto pairs = cli::read_direction_pairs(options.directions, reading_of());
  timed_plan result;
  result.plan = with_machine(options.machine, room,
                             [&](const auto& machine) { return gonio::capture::plan_scan(machine, pairs); });
  for (const auto& [number, reason] : result.plan.unreachable)
    std::cout << "not measured: " << number + 1 << ", " << in_degrees(pairs[number]) << ": " << reason << '\n';
  result.stops = result.plan.poses.size();
  return result;
}

/// Returns a line for each reading: the pose of each tool, and the lamp if the machine has several.
template <class Machine>
std::string pose_table(const Machine& machine, const std::vector<gonio::direction_pair>& pairs) {
  std::string text = "pose";
  std::vector<std::vector<gonio::capture::tool_pose>> paths;
  for (const lab::carried_tool& tool : machine.tools()) {
    for (const char* number : {"x", "y", "z", "qw", "qx", "qy", "qz"}) text += ',' + tool.name + '_' + number;
    std::vector<gonio::direction> directions;
    for (const gonio::direction_pair& pair : pairs) directions.push_back(pair.*tool.towards);
    paths.push_back(gonio::capture::tool_path(tool.sphere, directions));
  }
  constexpr bool has_lamps = requires { machine.arc(); };
  text += has_lamps ? ",lamp\n" : "\n";
  const auto rounded = [](double number) { return gonio::io::shortest(std::round(number * 1e9) / 1e9 + 0.0); };
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    text += std::to_string(i + 1);
    for (const auto& path : paths) {
      for (const double number : path[i].position) text += ',' + rounded(number);
      for (const double number : path[i].quaternion) text += ',' + rounded(number);
    }
    if constexpr (has_lamps) text += ',' + std::to_string(machine.arc().nearest(pairs[i].wi) + 1);
    text += '\n';
  }
  return text;
}

void write_poses(const plan_command& options, const std::vector<gonio::direction_pair>& pairs) {
  lab::dark_room room(lab::white(), {}, {});
  const std::string text =
      with_machine(options.machine, room, [&](const auto& machine) { return pose_table(machine, pairs); });
  gonio::io::write_atomically(options.poses, std::as_bytes(std::span(text)));
}

void run(const plan_command& options) {
  const auto [plan, stops, lamps] = plan_of(options);
  if (plan.poses.empty()) gonio::refuse("the machine cannot reach any of the directions");
  if (!options.poses.empty()) write_poses(options, plan.poses);
  gonio::io::write_direction_pairs(options.output, plan.poses);
  const double minutes = gonio::capture::duration_of_scan(plan.length, stops, lamps) / 60.0;
  std::cout << plan.poses.size() << " poses, " << plan.unreachable.size() << " cannot be reached; the path is "
            << fixed(gonio::degrees(plan.length), 0) << " degrees long, and a scan takes about " << fixed(minutes, 1)
            << " minutes\n";
}

}  // namespace

void add_lab_plan(command& lab) {
  auto command = lab.add_subcommand("plan", "Convert directions to poses of a machine, in the order of a short path");
  const auto options = std::make_shared<plan_command>();
  auto what = command.add_option_group("what", "Directions to measure (one of)");
  what.add_input("directions", options->directions, "Directions, as `gonio design` writes them (.csv)");
  what.add_flag("--whole", options->whole,
                "Measure every camera pose of the half hemisphere under every lamp of the robot's arc");
  what.require_option(1);
  add_machine_options(command, options->machine);
  command.add_output("--poses", options->poses, {".csv"},
                     "Table to write of the position and quaternion of the machine's moving parts for each pose (.csv, "
                     "docs/reference/formats.md)");
  command.add_output("-o,--output", options->output, {".csv"}, "Poses to write (.csv)").required();
  command.callback([options] { run(*options); });
}

}  // namespace cli
