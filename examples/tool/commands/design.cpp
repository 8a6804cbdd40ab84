/// `gonio design`: finds the measurements that best distinguish a prior's materials.

#include "commands.hpp"
#include "tool/files/json.hpp"
#include "tool/files/measurement_files.hpp"
#include "tool/options/design_search.hpp"
#include "tool/options/reconstruct_choice.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/options/team.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include "tool/pages/report_data.hpp"
#include "tool/pages/report_page.hpp"
#include "tool/pages/sample_facts.hpp"
#include <gonio/design/published_directions.hpp>
#include <gonio/evaluate/next_measurement.hpp>
#include <gonio/io/bytes/checked_file.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/io/setups/apparatus.hpp>

#include <iostream>
#include <memory>
#include <optional>

namespace cli {

namespace {

struct design_command {
  std::filesystem::path prior, constraint, start, given, output;
  std::string apparatus;  ///< name of a shipped apparatus
  /// If given, these values replace those of the apparatus: angles in degrees, and standard deviations of errors.
  std::optional<double> largest_polar_angle, separation, noise, dark_signal, misplaced;
  /// With --given: write nothing if half of all directions are known to this relative deviation.
  std::optional<double> until;
  page_option report;
  measurement_options reading;  ///< for --given
  design_options design;
  double field_of_view = 25.0, step = 5.0;
  Eigen::Index published = 0;  ///< size of the published set; 0: do not use one
  bool industry = false, print_json = false;
};

/// Refuses options of the criterion and of the search, which --given does not use.
void require_given_alone(const design_command& command) {
  const design_options standard, &design = command.design;
  if (design.geometry != standard.geometry) gonio::refuse("--given needs --geometry point");
  if (!command.start.empty()) gonio::refuse("--start is not available with --given");
  if (design.criterion != standard.criterion || design.search != standard.search || design.eta != standard.eta ||
      design.in_sample || design.common_shift != 0.0)
    gonio::refuse("--criterion, --search, --eta, --in-sample and --common-shift are not available with --given");
}

/// Writes the page for people. `samples` are already measured.
void write_report(const design_command& command, const std::vector<gonio::direction_pair>& poses,
                  const std::string& sentence, const gonio::sample_set& samples) {
  json directions = json::array(), given = json::array();
  for (const gonio::direction_pair& pose : poses) {
    json told = angles_as_json(pose);
    told["number"] = directions.size() + 1;
    directions.push_back(std::move(told));
  }
  for (const Eigen::Index i : gonio::counting_positions(samples))
    given.push_back(angles_as_json(samples[i].directions));
  json data{{"kind", "design"},
            {"name", command.output.stem().string()},
            {"design", {{"sentence", sentence}, {"directions", directions}}},
            {"samples", given},
            {"record", record_of({{"Prior", command.prior.string()}, {"Measured", command.given.string()}})}};
  if (!samples.empty()) {
    reconstruct_options fit;
    fit.noise = command.noise.value_or(0.0);
    fit.keeps_uncertainty = true;
    fit.materials.prior = command.prior;
    fit.threads = command.design.threads;
    data["map"] = known_map(reconstruct(fit, samples));
  }
  write_report_page(command.report, data);
}

/// Finds the next measurements, given the samples already measured.
void run_given(const design_command& command) {
  require_given_alone(command);
  const gonio::io::sample_file measured = read_colour_file(command.given, command.reading);
  const gonio::sample_set& samples = measured.samples;
  const gonio::reconstruction estimator{
      read_prior(command.prior), {.noise = command.noise.value_or(0.0)}, command.design.threads};
  const gonio::measurement_chooser chooser{estimator, command.design.apparatus, gonio::design::default_candidates(),
                                           command.design.threads};
  const auto paint = estimator.fit(samples);
  const double known_to = paint.certainty().known_to;
  const bool is_enough = command.until && known_to <= *command.until;
  const std::string known =
      counted(std::ssize(samples), "sample") + ": half of all directions are " + cli::known_to(known_to);
  json again = json::array();
  for (const Eigen::Index i : paint.rejected()) again.push_back(i + 1);
  json all{{"given", samples.size()}, {"known_to", known_to}, {"enough", is_enough}, {"measure_again", again}};
  all.update(facts_of(measured));
  if (is_enough) {
    std::cout << (command.print_json ? all.dump(2) : known + ", which is enough: nothing is written") << '\n';
    return;
  }
  const auto chosen = chooser.choose(samples, command.design.count);
  std::vector<gonio::direction_pair> poses;
  for (const gonio::next_measurement& next : chosen) poses.push_back(next.pose);
  gonio::io::write_direction_pairs(command.output, poses);
  const std::string sentence = known + "; " + std::to_string(poses.size()) +
                               (poses.size() == 1 ? " more leaves" : " more leave") + " an expected Delta E of " +
                               fixed(chosen.back().expected_delta_e, 2);
  if (command.report.is_given()) write_report(command, poses, sentence, samples);
  if (command.print_json) {
    all["measurements"] = poses.size();
    all["expected_delta_e"] = chosen.back().expected_delta_e;
    std::cout << all.dump(2) << '\n';
    return;
  }
  std::cout << sentence << '\n';
  for (const json& number : again.elements())
    std::cout << "measure sample " << number << " again: it disagrees with the others and does not count\n";
}

/// Refuses options of a search for a published set.
void require_no_search(const design_command& command) {
  const design_options standard, &design = command.design;
  const std::string asked = command.industry ? "--industry" : "--published";
  if (command.industry && command.published > 0)
    gonio::refuse("--industry and --published exclude each other: give one of them");
  if (design.geometry != "point" && (command.industry || design.geometry != "sphere"))
    gonio::refuse(asked + " needs --geometry point" + (command.industry ? "" : " or sphere"));
  if (!command.start.empty() || !command.given.empty() || !command.constraint.empty() || !command.apparatus.empty() ||
      design.criterion != standard.criterion || design.search != standard.search)
    gonio::refuse(asked +
                  " needs no search: --start, --given, --constraint, --apparatus, --criterion and --search are not "
                  "available with it");
}

/// Returns a published set. Its poses are as printed in the paper; for images, its samples are the pixels of the
/// nearest candidate images.
designed set_of_the_literature(const gonio::log_relative_pca& prior, const design_command& command) {
  const bool is_of_spheres = command.design.geometry == "sphere";
  designed found;
  found.samples = command.industry ? gonio::design::westlund_meyer_directions()
                  : is_of_spheres  ? gonio::design::nielsen_sphere_directions(command.published)
                                   : gonio::design::nielsen_directions(command.published);
  for (const gonio::half_difference& angles : found.samples) found.poses.push_back(gonio::to_directions(angles));
  if (is_of_spheres) found.samples = placed(prior, command.design, found.poses).samples;
  return found;
}

/// Writes the result and prints its quality.
void finish(const design_command& command, const gonio::log_relative_pca& prior, const designed& found,
            bool is_published) {
  gonio::io::write_direction_pairs(command.output, found.poses);
  const auto figures = quality_of(prior, command.design, found);
  const bool is_perceived =
      command.design.criterion == "perceived" && command.design.geometry == "point" && !is_published;
  const std::string sentence = std::to_string(found.poses.size()) +
                               (found.poses.size() == 1 ? " measurement: " : " measurements: ") +
                               (is_perceived ? "expected Delta E of spheres " + fixed(found.value, 2) + "; " : "") +
                               "expected error of a cell's logarithm " + fixed(figures.expected_error, 3) + " (" +
                               fixed(100.0 * figures.unknown_share, 1) + " % of the error without measurements)";
  if (command.report.is_given()) write_report(command, found.poses, sentence, {});
  if (command.print_json) {
    std::cout << json{{"measurements", found.poses.size()},
                      {"expected_delta_e", is_perceived ? json(found.value) : json()},
                      {"criterion", is_published ? "published" : command.design.criterion},
                      {"eta", command.design.eta},
                      {"in_sample", command.design.in_sample},
                      {"value", found.value},
                      {"expected_error", figures.expected_error},
                      {"unknown_share", figures.unknown_share}}
                     .dump(2)
              << '\n';
    return;
  }
  std::cout << sentence << '\n';
}

/// Returns the checksum of all inputs of a search.
std::uint32_t checksum_of(const design_command& command) {
  const design_options& design = command.design;
  std::vector<std::string> words{json{design.count, design.geometry, design.criterion, design.search, design.eta,
                                      design.apparatus.noise, design.apparatus.dark_signal,
                                      design.apparatus.angular_error, design.common_shift, design.in_sample,
                                      design.seed, command.field_of_view, command.step, command.apparatus,
                                      command.largest_polar_angle.value_or(-1.0), command.separation.value_or(-1.0)}
                                     .dump()};
  for (const std::filesystem::path& file : {command.prior, command.constraint, command.start})
    words.push_back(file.empty() ? "" : std::to_string(gonio::io::checksum(read_input(file))));
  return cli::checksum_of(words);
}

/// Searches, or resumes an earlier run from its record. Removes the record once the directions are written.
void search(const design_command& command, const gonio::log_relative_pca& prior, progress_bar& bar,
            const team& processes) {
  sweep_record record(command.output, checksum_of(command), processes);
  const designed found = design(prior, command.design, bar.listener(), processes, &record);
  bar.wipe();
  if (!processes.writes()) return;
  if (record.earlier() > 0 && !command.print_json) std::cout << "resumed after sweep " << record.earlier() << '\n';
  finish(command, prior, found, false);
  record.remove();
}

/// Returns the apparatus of --apparatus or --constraint, else the usual one, modified by other options.
gonio::design::apparatus apparatus_of(const design_command& command) {
  if (!command.constraint.empty() && !command.apparatus.empty())
    gonio::refuse("--constraint and --apparatus exclude each other: give one of them");
  gonio::design::apparatus chosen = !command.constraint.empty()  ? gonio::io::read_apparatus(command.constraint)
                                    : !command.apparatus.empty() ? shipped_apparatus(command.apparatus)
                                                                 : gonio::design::usual_apparatus();
  gonio::design::capture_constraint& constraint = chosen.constraint;
  if (command.largest_polar_angle)
    constraint.light.largest = constraint.viewer.largest = gonio::radians(*command.largest_polar_angle);
  if (command.separation) constraint.smallest_separation = gonio::radians(*command.separation);
  chosen.noise = command.noise.value_or(chosen.noise);
  chosen.dark_signal = command.dark_signal.value_or(chosen.dark_signal);
  if (command.misplaced) chosen.angular_error = gonio::radians(*command.misplaced);
  // Only the criteria expected-error and perceived include angular errors, and only for single directions. Otherwise,
  // the angular error of the apparatus is ignored.
  const bool expects_errors = command.design.criterion == "expected-error" || command.design.criterion == "perceived";
  if (!command.misplaced && !(command.design.geometry == "point" && expects_errors)) chosen.angular_error = 0.0;
  return chosen;
}

/// Chooses the directions: with --given, from a published set, or by a search.
void run(design_command command, const team& processes) {
  progress_bar bar;
  const bool is_published = command.published > 0 || command.industry;
  if (is_published) require_no_search(command);
  command.design.apparatus = apparatus_of(command);
  if (!command.given.empty()) {
    if (processes.writes()) run_given(command);
    return;
  }
  if (!command.reading.empty()) gonio::refuse("--quantity, --columns, --theta-o-sign, --side and --band need --given");
  if (command.until) gonio::refuse("--until needs --given");
  if (command.noise && command.design.criterion == "condition")
    gonio::refuse("--noise needs --criterion expected-error or perceived: a condition number does not depend on noise");
  const auto prior = read_prior(command.prior);
  command.design.near_field.field_of_view = gonio::radians(command.field_of_view);
  command.design.near_field.step = gonio::radians(command.step);
  if (!command.start.empty()) command.design.start = cli::read_direction_pairs(command.start, reading_of());
  if (!is_published) return search(command, prior, bar, processes);
  bar.wipe();
  if (processes.writes()) finish(command, prior, set_of_the_literature(prior, command), true);
}

void run_together(design_command command, const team& processes) {
  command.design.threads = processes.threads(command.design.threads);
  agree_on_file(processes, command.prior, "prior");
  agree_on_file(processes, command.constraint, "--constraint");
  agree_on_file(processes, command.start, "--start");
  processes.together([&] { run(command, processes); });
}

}  // namespace

void add_design(command& app, const std::vector<std::string>& words, const team& processes) {
  auto command = app.add_subcommand("design", "Choose the directions to measure");
  const auto options = std::make_shared<design_command>();
  design_options& design = options->design;
  // Declare the prior and the measurements.
  add_prior_option(command, options->prior);
  command.add_option("-n,--count", design.count, "Number of measurements").capture_default_str();
  command
      .add_option("--geometry", design.geometry,
                  "point: single directions of a goniometer; sphere: images of a sphere; near-field: images of a flat "
                  "sample by a close camera; fixed-camera, fixed-light: near-field with one camera, or one light")
      .check(check::one_of({"point", "sphere", "near-field", "fixed-camera", "fixed-light"}))
      .capture_default_str();
  // Declare the criterion and the search.
  command
      .add_option("--criterion", design.criterion,
                  "perceived: visible error of gonio reconstruct for the prior's materials; expected-error: Xu et al. "
                  "2016; condition: condition number, Nielsen et al. 2015; a-optimal, d-optimal: trace or determinant "
                  "of the weights' covariance")
      .check(check::one_of({"expected-error", "perceived", "condition", "a-optimal", "d-optimal"}))
      .capture_default_str();
  command
      .add_option(
          "--search", design.search,
          "greedy: add the best candidate again and again, so that a longer set begins with the shorter one; exchange: "
          "greedy, then replace candidates while that helps; descent: move random candidates to better neighbours")
      .check(check::one_of({"greedy", "exchange", "descent"}))
      .capture_default_str();
  // Declare the reconstruction and the errors of the measurements.
  command
      .add_option("--eta", design.eta,
                  "Tikhonov's penalty of the reconstruction. The default is close to the choice of gonio reconstruct")
      .capture_default_str();
  command
      .add_option("--common-shift", design.common_shift,
                  "Size of a shift common to all logarithms: beta of Xu et al. 2016, Eq. 15")
      .capture_default_str();
  command.add_flag("--in-sample", design.in_sample,
                   "Compute each material's error with a prior that has learned this material, as Xu et al. do, "
                   "instead of leaving it out");
  // Declare the limits of the apparatus.
  command
      .add_option("--fov", options->field_of_view,
                  "Near field: angle in degrees that the sample spans, seen from above")
      .capture_default_str();
  command.add_option("--step", options->step, "Near field: degrees between candidates").capture_default_str();
  command.add_option("--apparatus", options->apparatus,
                     "Named apparatus (default: light and viewer up to 80 degrees from the normal, at least 5 degrees "
                     "apart, noise of 2 %): " +
                         gonio::io::listed(shipped_apparatus_names(), ", "));
  command.add_input("--constraint", options->constraint,
                    "File of your own apparatus, instead of --apparatus (text, docs/reference/formats.md)");
  command
      .add_option("--largest-polar-angle", options->largest_polar_angle,
                  "Largest angle of light and viewer from the normal, in degrees, instead of the apparatus' limits")
      .check(check::range(1.0, 90.0));
  command.add_option("--separation", options->separation, "Smallest angle between light and viewer, in degrees")
      .check(check::range(0.0, 180.0));
  command.add_option("--noise", options->noise, "Independent relative deviation of each reading (0.02 is 2 %)")
      .check(check::range(0.0, 1.0));
  command
      .add_option("--dark-signal", options->dark_signal,
                  "Standard deviation of a reading without light, in sr^-1: as a value of the BRDF times the cosines "
                  "of light and viewer. It matters at grazing angles")
      .check(check::range(0.0, 1.0));
  command.add_option("--misplaced", options->misplaced,
                     "With --geometry point: error of the directions of light and of viewer, in degrees");
  command.add_input("--start", options->start, "Directions that are already decided; the search adds to them (.csv)");
  command.add_input("--given", options->given,
                    "Samples already measured (.csv): choose the next directions by their values, for the least "
                    "visible error of spheres");
  command
      .add_option(
          "--until", options->until,
          "With --given: write nothing if half of all directions are known to this relative deviation (0.1 is 10 %)")
      .check(check::range(0.0, 1.0));
  add_measurement_options(command, options->reading);
  // Declare the sets that need no search.
  command
      .add_option("--published", options->published,
                  "Use the set of Nielsen et al. 2015, without a search: number of points (1, 2, 5, 10, 20) or, with "
                  "--geometry sphere, of images (1, 2, 5)")
      .check(check::range(1, 20));
  command.add_flag(
      "--industry", options->industry,
      "Use the five points of industrial goniospectrophotometers, without a search (Westlund and Meyer 2001)");
  // Declare the run and its output.
  command.add_option("--seed", design.seed, "Seed of the random candidates").capture_default_str();
  add_report_option(command, options->report, words);
  command.add_flag("--json", options->print_json, "Print the result as JSON");
  add_threads_option(command, design.threads);
  command
      .add_output("-o,--output", options->output, {".csv"},
                  "Directions to write (.csv); for images, the directions at the centre of each image")
      .required();
  command.callback([options, &processes] { run_together(*options, processes); });
}

}  // namespace cli
