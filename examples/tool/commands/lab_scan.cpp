/// gonio lab scan, gonio lab replay: readings of a machine or of recorded frames, saved one by one in a journal.

#include "adaptive_scan.hpp"
#include "lab.hpp"
#include "lab/recorded_frames.hpp"
#include "tool/files/file_kinds.hpp"
#include "tool/files/json.hpp"
#include "tool/files/measurement_files.hpp"
#include "tool/options/machine_choice.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/capture/scan.hpp>
#include <gonio/core/printable.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/io/measurements/scan_journal.hpp>

#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>

namespace cli {

namespace {

struct scan_command {
  std::filesystem::path plan, material, output;
  machine_choice machine;
  bool white = false, lamp = false, ideal = false, adaptive = false;
  double transmittance = 1.0;  ///< of the filter through which the camera looks into the lamp
  adaptive_options choice;
  std::string camera = "linear", label;
  std::filesystem::path reflectance = "0.99";  ///< of the white reference: a number, or a table's file
  double misalignment = 0.5, outliers = 0.0, noise = 1.0;
  std::uint64_t room_seed = 1, seed = 1;
};

struct replay_command {
  std::filesystem::path manifest, output;
  std::string label;
};

lab::response_curve curve_named(const std::string& name) {
  if (name == "gamma") return lab::response_curve::gamma;
  return name == "s-shaped" ? lab::response_curve::s_shaped : lab::response_curve::linear;
}

lab::surface surface_of(const scan_command& options) {
  if (options.white) return lab::white(reflectance_of(options.reflectance));
  if (options.lamp) return lab::lamp_through(options.transmittance);
  return [table = read_table(options.material)](const gonio::direction& wi, const gonio::direction& wo) {
    return table(wi, wo);
  };
}

/// Returns the laboratory that the options describe.
lab::dark_room room_of(const scan_command& options) {
  lab::sensor chip{.curve = curve_named(options.camera)};
  lab::defects wrong;
  if (!options.ideal) {
    chip = lab::sensor::usual(curve_named(options.camera));
    chip.read_noise *= options.noise;
    chip.full_well /= options.noise * options.noise;
    wrong = lab::defects::usual();
    wrong.flicker *= options.noise;
    wrong.misalignment = gonio::radians(options.misalignment);
  }
  wrong.outliers = options.outliers;
  // Reference and material have different seeds for their alignment.
  return {surface_of(options), chip, wrong, options.room_seed, 2 * options.seed + (options.white ? 1 : 0)};
}

using gonio::io::shortest;

/// Returns the journal's subject. Options that do not affect the counts are left out.
gonio::io::scan_subject subject_of(const scan_command& options) {
  gonio::io::scan_subject subject;
  subject.seed = options.seed;
  if (options.white) {
    const auto number = number_of_reflectance(options.reflectance);
    const std::string reflectance = number ? shortest(*number) : "of " + options.reflectance.filename().string();
    subject.sample = "white reference, reflectance " + reflectance;
    if (!number) subject.checksum = gonio::io::checksum_of_file(options.reflectance);
  } else if (options.lamp) {
    subject.sample = "lamp through a filter of transmittance " + shortest(options.transmittance);
  } else {
    subject.sample = options.material.filename().string();
    subject.checksum = gonio::io::checksum_of_file(options.material);
  }
  if (!options.label.empty()) subject.sample = options.label;
  subject.setup = "machine " + options.machine.name;
  if (options.machine.name == "robot") subject.setup += ", lamp tolerance " + shortest(options.machine.tolerance);
  subject.setup += ", camera " + options.camera;
  if (options.ideal)
    subject.setup += ", ideal";
  else
    subject.setup += ", noise " + shortest(options.noise) + ", misaligned " + shortest(options.misalignment);
  subject.setup += ", outliers " + shortest(options.outliers) + ", room seed " + std::to_string(options.room_seed);
  if (options.adaptive) subject.setup += ", adaptive";
  return subject;
}

/// Returns the subject of a list of frames, including its folder's name: lists of two materials may be identical.
gonio::io::scan_subject subject_of(const replay_command& options) {
  const auto folder = std::filesystem::absolute(options.manifest).lexically_normal().parent_path().filename();
  return {.sample = options.label.empty() ? (folder / options.manifest.filename()).string() : options.label,
          .checksum = gonio::io::checksum_of_file(options.manifest),
          .setup = "recorded frames"};
}

/// Measures the poses missing in a journal, and prints those that cannot be measured.
template <class Machine>
gonio::capture::scan_outcome measure_missing(gonio::io::scan_journal& journal, Machine& machine) {
  const std::vector<gonio::direction_pair>& poses = journal.scan().poses;
  progress_bar bar;
  gonio::capture::scan_outcome outcome = gonio::capture::scan(machine, poses, journal, {}, bar.listener());
  bar.wipe();
  for (const auto& [number, reason] : outcome.missing)
    std::cout << "missing: pose " << number + 1 << ", " << in_degrees(poses[number]) << ": " << gonio::printable(reason)
              << '\n';
  return outcome;
}

/// Throws if poses remain missing.
void require_complete(const std::filesystem::path& output, const gonio::io::recorded_scan& scan) {
  if (scan.measured() == scan.poses.size()) return;
  throw std::runtime_error(output.string() + ": " + std::to_string(scan.poses.size() - scan.measured()) + " of " +
                           std::to_string(scan.poses.size()) +
                           " poses are missing: run the same command again to measure them");
}

/// Scans the poses missing in the journal.
template <class Machine>
void scan_into(const std::filesystem::path& output, const gonio::io::scan_subject& subject, Machine& machine,
               const std::vector<gonio::direction_pair>& poses) {
  gonio::io::scan_journal journal(output, subject, poses, machine.largest_count());
  const gonio::capture::scan_outcome outcome = measure_missing(journal, machine);
  std::cout << outcome.measured << " poses measured, " << outcome.kept_before << " were already there\n";
  require_complete(output, journal.scan());
}

/// Scans the given poses, and then poses chosen from the readings, up to the limits of --until and --most.
template <class Machine>
void scan_adaptively(const scan_command& options, Machine& machine, const std::vector<gonio::direction_pair>& poses) {
  const adaptive_choice choice(options.choice, {.reflectance = options.reflectance}, machine.largest_count());
  gonio::io::scan_journal journal(options.output, subject_of(options), poses, machine.largest_count());
  const auto placed = [&](const gonio::direction_pair& pair) {
    return gonio::capture::place_either_way(machine, pair);
  };
  Eigen::Index measured = 0;
  for (bool is_known = false; !is_known;) {
    const gonio::capture::scan_outcome outcome = measure_missing(journal, machine);
    measured += outcome.measured;
    if (outcome.is_broken_off) require_complete(options.output, journal.scan());
    const auto next = choice.next(journal.scan(), [&](const auto& pair) { return placed(pair).is_reachable(); });
    if (next) journal.add_pose(placed(*next).at);
    is_known = !next.has_value();
  }
  std::cout << measured << " poses measured, " << std::ssize(journal.scan().poses) << " in total\n";
}

void run(const scan_command& options, bool is_filtered) {
  if (options.adaptive && options.material.empty())
    gonio::refuse(std::string("--adaptive needs --material, not ") + (options.white ? "--white" : "--lamp"));
  if (options.adaptive && options.choice.reference.empty())
    gonio::refuse("--adaptive needs --reference, a scan of the white reference by the same machine");
  if (!options.adaptive && !options.choice.reference.empty()) gonio::refuse("--reference needs --adaptive");
  if (is_filtered && !options.lamp) gonio::refuse("--filter-transmittance needs --lamp");
  const auto poses = cli::read_direction_pairs(options.plan, reading_of());
  lab::dark_room room = room_of(options);
  with_machine(options.machine, room, [&](auto& machine) {
    if (options.adaptive) return scan_adaptively(options, machine, poses);
    scan_into(options.output, subject_of(options), machine, poses);
  });
  if (options.lamp)
    std::cout << "the lamp's solid angle is " << shortest(lab::lamp_solid_angle()) << " sr (lab calibrate "
              << "--lamp-solid-angle)\n";
}

void run(const replay_command& options) {
  lab::recorded_frames recorded(options.manifest);
  scan_into(options.output, subject_of(options), recorded, recorded.poses());
}

void add_label_option(command& to, std::string& label) {
  to.add_option("--label", label,
                "Name of the sample in the machine. A journal is continued only with the same name (default: the name "
                "of the file)");
}

}  // namespace

void add_lab_scan(command& lab) {
  auto command = lab.add_subcommand("scan", "Measure poses in a simulated laboratory; resumes an interrupted scan");
  const auto options = std::make_shared<scan_command>();
  // Declare the plan and the sample in the machine.
  command.add_input("plan", options->plan, "Poses, as `gonio lab plan` writes them (.csv)").required();
  auto what = command.add_option_group("what", "Sample in the machine (one of)");
  what.add_input("--material", options->material, "Table of a material (.binary, .binary.gz, .npy, .bsdf or .mbsdf)");
  what.add_flag("--white", options->white, "Measure the white reference");
  what.add_flag("--lamp", options->lamp, "Measure the lamp: the camera looks into it at each pose");
  what.require_option(1);
  command
      .add_option("--filter-transmittance", options->transmittance,
                  "With --lamp: transmittance of the filter before the camera")
      .check(check::range(1e-9, 1.0))
      .capture_default_str();
  add_reflectance_option(command, options->reflectance);
  add_label_option(command, options->label);
  // Declare the machine and its camera.
  add_machine_options(command, options->machine);
  command.add_option("--camera", options->camera, "Response of the camera")
      .check(check::one_of({"linear", "gamma", "s-shaped"}))
      .capture_default_str();
  // Declare the defects.
  command.add_flag(
      "--ideal", options->ideal,
      "Simulate a perfect laboratory: no noise, lamp and sample as points, exact alignment, 16 bits instead of 12");
  command.add_option("--noise", options->noise, "Factor that multiplies all noise (0: none, 1: as usual)")
      .check(check::non_negative_number())
      .capture_default_str();
  command.add_option("--misaligned", options->misalignment, "Misalignment of lamps, camera and sample, in degrees")
      .check(check::range(0.0, 10.0))
      .capture_default_str();
  command
      .add_option("--outliers", options->outliers,
                  "Share of poses that are outliers: their light is multiplied by a random factor from 0.1 to 10")
      .check(check::range(0.0, 1.0))
      .capture_default_str();
  // Declare the choice of poses.
  command.add_flag("--adaptive", options->adaptive, "Choose further poses after the plan, from the readings");
  command.add_input("--reference", options->choice.reference,
                    "With --adaptive: a scan of the white reference, at poses with about the same lights (.scan)");
  command
      .add_option("--until", options->choice.until,
                  "With --adaptive: stop when half of all directions are known to this relative deviation. Values "
                  "below 0.04 are never reached")
      .check(check::range(0.001, 1.0))
      .capture_default_str();
  command.add_option("--most", options->choice.most, "With --adaptive: largest number of poses in total")
      .check(check::range(1, 1000))
      .capture_default_str();
  add_prior_option(command, options->choice.prior);
  // Declare the seeds and the journal.
  command.add_option("--room-seed", options->room_seed, "Seed of the misalignment of lamps and camera")
      .capture_default_str();
  command.add_option("--seed", options->seed, "Seed of the misalignment of the sample, of noise and of outliers")
      .capture_default_str();
  command.add_output("-o,--output", options->output, {".scan"}, "Journal to write or to continue (.scan)").required();
  command.callback([options, command] { run(*options, command.count("--filter-transmittance") > 0); });
}

void add_lab_replay(command& lab) {
  auto command = lab.add_subcommand("replay", "Convert recorded frames to a scan");
  const auto options = std::make_shared<replay_command>();
  command.add_input("manifest", options->manifest, "List of frames and their poses (.json, docs/reference/formats.md)")
      .required();
  add_label_option(command, options->label);
  command.add_output("-o,--output", options->output, {".scan"}, "Journal to write or to continue (.scan)").required();
  command.callback([options] { run(*options); });
}

}  // namespace cli
