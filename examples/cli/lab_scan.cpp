/// gonio lab scan, gonio lab replay: readings of a machine, or of frames recorded earlier, kept one by one in a
/// journal.

#include "command_line/json.hpp"
#include "command_line/machine_choice.hpp"
#include "command_line/progress_bar.hpp"
#include "lab.hpp"
#include "lab/recorded_frames.hpp"
#include <gonio/capture/scan.hpp>
#include <gonio/core/printable.hpp>
#include <gonio/io/merl_gzip.hpp>
#include <gonio/io/samples.hpp>
#include <gonio/io/scan_journal.hpp>

#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>

namespace cli {

namespace {

struct scan_command {
  std::filesystem::path plan, material, output;
  machine_choice machine;
  bool white = false, ideal = false;
  std::string camera = "linear", label;
  double reflectance = 0.99, misalignment = 0.5, outliers = 0.0, noise = 1.0;
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
  if (options.white) return lab::white(options.reflectance);
  return [table = gonio::io::read_merl_any(options.material)](const gonio::direction& wi, const gonio::direction& wo) {
    return table(wi, wo);
  };
}

/// The laboratory that the options describe.
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
  // The reference and the material are laid down apart.
  return {surface_of(options), chip, wrong, options.room_seed, 2 * options.seed + (options.white ? 1 : 0)};
}

using gonio::io::detail::shortest;

/// What the journal says that it is of. Options that change no count are left out.
gonio::io::scan_subject subject_of(const scan_command& options) {
  gonio::io::scan_subject subject;
  subject.seed = options.seed;
  if (options.white) {
    subject.sample = "white reference, reflectance " + shortest(options.reflectance);
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
  return subject;
}

/// The list of frames, and the folder that it lies in: lists of two materials may be the same.
gonio::io::scan_subject subject_of(const replay_command& options) {
  const auto folder = std::filesystem::absolute(options.manifest).lexically_normal().parent_path().filename();
  return {.sample = options.label.empty() ? (folder / options.manifest.filename()).string() : options.label,
          .checksum = gonio::io::checksum_of_file(options.manifest),
          .setup = "recorded frames"};
}

/// Scans what the journal does not have yet. Throws where poses stay missing.
template <class Machine>
void scan_into(const std::filesystem::path& output, const gonio::io::scan_subject& subject, Machine& machine,
               const std::vector<gonio::direction_pair>& poses) {
  gonio::io::scan_journal journal(output, subject, poses, machine.largest_count());
  progress_bar bar;
  const gonio::capture::scan_outcome outcome = gonio::capture::scan(machine, poses, journal, {}, bar.listener());
  bar.wipe();
  for (const auto& [number, reason] : outcome.missing)
    std::cout << "missing: pose " << number + 1 << ", " << in_degrees(poses[number]) << ": " << gonio::printable(reason)
              << '\n';
  std::cout << outcome.measured << " poses measured, " << outcome.kept_before << " were there already\n";
  if (outcome.is_complete()) return;
  throw std::runtime_error(output.string() + ": " + std::to_string(poses.size() - journal.scan().measured()) + " of " +
                           std::to_string(poses.size()) + " poses are missing: the same command tries them again");
}

void run(const scan_command& options) {
  const auto poses = gonio::io::read_direction_pairs(options.plan);
  lab::dark_room room = room_of(options);
  with_machine(options.machine, room,
               [&](auto& machine) { scan_into(options.output, subject_of(options), machine, poses); });
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
  // Declare the plan and what lies in the machine.
  command.add_input("plan", options->plan, "Poses, as `gonio lab plan` writes them (.csv)").required();
  auto what = command.add_option_group("what", "What lies in the machine (one of)");
  what.add_input("--material", options->material, "A material's table (.binary or .binary.gz)");
  what.add_flag("--white", options->white, "The white reference");
  what.require_option(1);
  command.add_option("--reflectance", options->reflectance, "Of the white reference")
      .check(check::range(0.01, 1.0))
      .capture_default_str();
  add_label_option(command, options->label);
  // Declare the machine and its camera.
  add_machine_options(command, options->machine);
  command.add_option("--camera", options->camera, "The camera's response")
      .check(check::one_of({"linear", "gamma", "s-shaped"}))
      .capture_default_str();
  // Declare what is wrong with it.
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
