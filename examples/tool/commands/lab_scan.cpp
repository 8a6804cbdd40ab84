/// gonio lab scan, gonio lab replay: readings of a machine or of recorded frames, saved one by one in a journal.

#include "adaptive_scan.hpp"
#include "lab.hpp"
#include "lab/recorded_frames.hpp"
#include "tool/files/json.hpp"
#include "tool/files/measurement_files.hpp"
#include "tool/options/machine_choice.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/capture/scan.hpp>
#include <gonio/core/printable.hpp>
#include <gonio/io/materials/merl_gzip.hpp>
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
  bool white = false, ideal = false, adaptive = false;
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
  return [table = gonio::io::read_merl_any(options.material)](const gonio::direction& wi, const gonio::direction& wo) {
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
                           std::to_string(scan.poses.size()) + " poses are missing: the same command tries them again");
}

/// Scans the poses missing in the journal.
template <class Machine>
void scan_into(const std::filesystem::path& output, const gonio::io::scan_subject& subject, Machine& machine,
               const std::vector<gonio::direction_pair>& poses) {
  gonio::io::scan_journal journal(output, subject, poses, machine.largest_count());
  const gonio::capture::scan_outcome outcome = measure_missing(journal, machine);
  std::cout << outcome.measured << " poses measured, " << outcome.kept_before << " were there already\n";
  require_complete(output, journal.scan());
}

/// Continues with poses chosen from the readings, until the material is known well enough.
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
  std::cout << measured << " poses measured, " << std::ssize(journal.scan().poses) << " in all\n";
}

void run(const scan_command& options) {
  if (options.adaptive && options.white)
    gonio::refuse("--adaptive needs --material: the white reference is what its readings are compared with");
  if (options.adaptive && options.choice.reference.empty())
    gonio::refuse("--adaptive needs --reference, a scan of the white reference by the same machine");
  if (!options.adaptive && !options.choice.reference.empty()) gonio::refuse("--reference needs --adaptive");
  const auto poses = cli::read_direction_pairs(options.plan, reading_of());
  lab::dark_room room = room_of(options);
  with_machine(options.machine, room, [&](auto& machine) {
    if (options.adaptive) return scan_adaptively(options, machine, poses);
    scan_into(options.output, subject_of(options), machine, poses);
  });
}

void run(const replay_command& options) {
  lab::recorded_frames recorded(options.manifest);
  scan_into(options.output, subject_of(options), recorded, recorded.poses());
}

void add_label_option(command& to, std::string& label) {
  to.add_option("--label", label,
                "What lies in the machine, in words: a journal is gone on with only for the same (default: the name "
                "of the file)");
}

}  // namespace

void add_lab_scan(command& lab) {
  auto command = lab.add_subcommand("scan", "Measure poses in a simulated laboratory; goes on where it was stopped");
  const auto options = std::make_shared<scan_command>();
  // Declare the plan and the sample in the machine.
  command.add_input("plan", options->plan, "Poses, as `gonio lab plan` writes them (.csv)").required();
  auto what = command.add_option_group("what", "What lies in the machine (one of)");
  what.add_input("--material", options->material, "A material's table (.binary or .binary.gz)");
  what.add_flag("--white", options->white, "The white reference");
  what.require_option(1);
  add_reflectance_option(command, options->reflectance);
  add_label_option(command, options->label);
  // Declare the machine and its camera.
  add_machine_options(command, options->machine);
  command.add_option("--camera", options->camera, "The camera's response")
      .check(check::one_of({"linear", "gamma", "s-shaped"}))
      .capture_default_str();
  // Declare the defects.
  command.add_flag("--ideal", options->ideal,
                   "Nothing is wrong: no noise, points for lamp and sample, all in its place, 16 bits instead of 12");
  command.add_option("--noise", options->noise, "Factor of all noise")
      .check(check::non_negative_number())
      .capture_default_str();
  command.add_option("--misaligned", options->misalignment, "Degrees by which lamps, camera and sample are off")
      .check(check::range(0.0, 10.0))
      .capture_default_str();
  command.add_option("--outliers", options->outliers, "Share of poses with up to 10 times the light, or a tenth")
      .check(check::range(0.0, 1.0))
      .capture_default_str();
  // Declare the choice of poses.
  command.add_flag("--adaptive", options->adaptive, "Go on beyond the plan, with the poses that the readings ask for");
  command.add_input("--reference", options->choice.reference,
                    "With --adaptive: a scan of the white reference, at poses with about the same lights (.scan)");
  command
      .add_option(
          "--until", options->choice.until,
          "With --adaptive: stop when half of all directions are known to this, relative; 0.04 stays, whatever is "
          "measured")
      .check(check::range(0.001, 1.0))
      .capture_default_str();
  command.add_option("--most", options->choice.most, "With --adaptive: poses in all")
      .check(check::range(1, 1000))
      .capture_default_str();
  add_prior_option(command, options->choice.prior);
  // Declare the seeds and the journal.
  command.add_option("--room-seed", options->room_seed, "Seed of how lamps and camera are off").capture_default_str();
  command.add_option("--seed", options->seed, "Seed of how the sample lies, and of noise and outliers")
      .capture_default_str();
  command.add_output("-o,--output", options->output, {".scan"}, "Journal to write, or to go on with (.scan)")
      .required();
  command.callback([options] { run(*options); });
}

void add_lab_replay(command& lab) {
  auto command = lab.add_subcommand("replay", "Frames that were recorded earlier, as a scan");
  const auto options = std::make_shared<replay_command>();
  command.add_input("manifest", options->manifest, "Which file was taken where (.json, docs/reference/formats.md)")
      .required();
  add_label_option(command, options->label);
  command.add_output("-o,--output", options->output, {".scan"}, "Journal to write, or to go on with (.scan)")
      .required();
  command.callback([options] { run(*options); });
}

}  // namespace cli
