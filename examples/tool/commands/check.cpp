/// gonio check: does a part reflect like a reference?

#include "check_answer.hpp"
#include "commands.hpp"
#include "tool/files/measurement_files.hpp"
#include "tool/options/negative_answer.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/elapsed_time.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/measures_as_json.hpp"
#include "tool/pages/report_page.hpp"
#include "tool/pages/sample_facts.hpp"
#include <gonio/conformity/conformity.hpp>
#include <gonio/io/text/text.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>

namespace cli {

namespace {

struct check_options {
  std::vector<std::filesystem::path> parts;
  std::filesystem::path reference, prior;
  page_option report;
  measurement_options reading;
  std::optional<double> noise, reference_noise;
  std::vector<double> tolerance;
  std::optional<double> peak_tolerance;
  double dark_noise = 0.0, delta_e = 0.0, same_within = 0.01;
  check_question question;
  bool print_json = false;
  gonio::thread_count threads;
};

measured_surface surface_of(gonio::io::sample_file file, const std::filesystem::path& path, const check_options& given,
                            const gonio::log_relative_pca& prior) {
  measured_surface surface{.name = path.string(),
                           .counting = {},
                           .numbers = {},
                           .lines = std::move(file.text.lines),
                           .located = gonio::locate_samples(prior.cells(), file.samples, given.threads),
                           .facts = facts_of(file)};
  for (const Eigen::Index i : gonio::counting_positions(file.samples)) {
    surface.counting.push_back(file.samples.directions(i));
    surface.numbers.push_back(i + 1);
  }
  return surface;
}

/// Reads part and reference. If their channels differ, reads both as colours.
std::pair<measured_surface, measured_surface> read_both(const std::filesystem::path& path, const check_options& given,
                                                        const gonio::log_relative_pca& prior) {
  gonio::io::sample_file part = read_measurement_file(path, given.reading),
                         reference = read_measurement_file(given.reference, given.reading);
  const gonio::channels &of_part = part.samples.channels(), &of_reference = reference.samples.channels();
  if (!(of_part == of_reference) && !(of_part.size() == 1 && of_reference.size() == 1)) {
    if (of_part.are_wavelengths() && of_reference.are_wavelengths())
      gonio::refuse({path.native(), ": its wavelengths differ from those of ", given.reference.native(),
                     ", but check needs the same wavelengths"});
    if ((of_part.size() == 1) != (of_reference.size() == 1))
      gonio::refuse({path.native(), ": has ", counted(of_part.size(), "channel"), ", but ", given.reference.native(),
                     " has ", of_reference.size(), ", expected the same channels"});
    part.samples = as_colours(path, part.samples).colours();
    reference.samples = as_colours(given.reference, reference.samples).colours();
  }
  return {surface_of(std::move(part), path, given, prior),
          surface_of(std::move(reference), given.reference, given, prior)};
}

/// Returns the options with the noise as stated, or as estimated from repeated measurements.
gonio::conformity_options options_of(const check_options& given, const gonio::log_relative& metric,
                                     const measured_surface& part, const measured_surface& reference) {
  gonio::conformity_options options{.part = {},
                                    .reference = {},
                                    .peak_tolerance = given.peak_tolerance,
                                    .delta_e = given.delta_e,
                                    .same_direction = gonio::radians(given.same_within)};
  if (!given.tolerance.empty()) options.tolerance = given.tolerance;
  if (given.noise) {
    options.part.relative = *given.noise;
    options.reference.relative = given.reference_noise.value_or(*given.noise);
  } else {
    if (given.reference_noise) gonio::refuse("--reference-noise needs --noise");
    options.part = options.reference = gonio::pooled_noise(gonio::noise_of_repeats(metric, part.located, options),
                                                           gonio::noise_of_repeats(metric, reference.located, options));
    if (options.part.degrees_of_freedom == 0.0)
      gonio::refuse("check needs --noise (relative deviation of the measurements, 0.02 is 2 %), or " +
                    std::string("directions measured more than once, to estimate it"));
  }
  options.part.dark = options.reference.dark = given.dark_noise;
  return options;
}

checked_part check_part(const check_options& given, const measured_surface& part, const measured_surface& reference,
                        const gonio::log_relative_pca& prior) {
  const elapsed_time waiting("comparing " + part.name);
  checked_part checked{part, reference, options_of(given, prior.metric(), part, reference), {}, {}};
  const gonio::reconstruction estimator{prior, {.noise = checked.options.part.relative}, given.threads};
  checked.found = gonio::check_conformity(estimator, part.located, reference.located, checked.options);
  checked.familiarity = estimator.process_of(part.located).familiarity();
  checked.conforms = checked.found.conforms(given.question.false_alarms);
  return checked;
}

/// Writes the page for people: the result, and the record of the command.
void write_report(const check_options& given, const json& check) {
  const auto described = [](const std::filesystem::path& path, const json& facts) {
    std::string text = path.string();
    for (const char* fact : {"quantity", "instrument", "date", "conditions"})
      if (facts.contains(fact)) text.append("; ").append(fact).append(": ").append(facts[fact].text());
    return text;
  };
  const json record =
      record_of({{"Part", described(given.parts.front(), check["part"])},
                 {"Reference", described(given.reference, check["reference"])},
                 {"Prior", given.prior.string()},
                 {"Noise", fixed(100.0 * check["noise"].number(), 2) + " %" +
                               (given.noise ? " (stated)" : " (estimated from repeated measurements)")}});
  write_report_page(given.report,
                    {{"kind", "check"},
                     {"name", given.parts.front().stem().string() + " beside " + given.reference.stem().string()},
                     {"check", check},
                     {"record", record}});
}

/// Prints the answer, and returns whether all parts conform.
bool check_files(const check_options& given) {
  if (given.parts.size() > 1 && given.report.is_given())
    gonio::refuse({"--report needs one part, not ", given.parts.size()});
  const gonio::log_relative_pca prior = read_prior(given.prior);
  std::vector<std::pair<measured_surface, measured_surface>> surfaces;
  for (const std::filesystem::path& part : given.parts) surfaces.push_back(read_both(part, given, prior));
  std::vector<checked_part> checked;
  for (const auto& [part, reference] : surfaces) checked.push_back(check_part(given, part, reference, prior));
  json told = json::array();
  for (const checked_part& each : checked) told.push_back(as_json(given.question, each));
  if (given.report.is_given()) write_report(given, told[0]);
  if (given.print_json)
    std::cout << (checked.size() == 1 ? told[0] : told).dump(2) << '\n';
  else if (checked.size() > 1)
    print_table(given.question, checked);
  else
    print_verdict(given.question, checked.front());
  return std::ranges::all_of(checked, &checked_part::conforms);
}

/// Calls `check_files` and reports every failure as bad input: exit code 1 means only that a part differs.
bool check_or_refuse(const check_options& given) {
  try {
    return check_files(given);
  } catch (const gonio::error&) {
    throw;
  } catch (const std::exception& failure) {
    gonio::refuse(std::string("the part could not be checked: ") + failure.what());
  }
}

void add_noise_options(command& to, check_options& options) {
  to.add_option("--noise", options.noise,
                "Relative deviation of the measured values (0.02 is 2 %), independent in each channel of each sample "
                "(default: estimated from directions measured more than once)")
      .check(check::range(1e-6, 0.3));
  to.add_option("--reference-noise", options.reference_noise,
                "Relative deviation of the reference's values (default: that of --noise)")
      .check(check::range(0.0, 0.3));
  to.add_option("--dark-noise", options.dark_noise,
                "Absolute standard deviation of the values in sr^-1; it matters for values near zero")
      .check(check::range(0.0, 1e6))
      .capture_default_str();
}

}  // namespace

void add_check(command& app, const std::vector<std::string>& words) {
  auto command = app.add_subcommand(
      "check", "Check whether a part reflects like a reference: GO (exit code 0) or NO-GO (exit code 1)");
  const auto options = std::make_shared<check_options>();
  command
      .add_input(
          "part", options->parts,
          "Measurements of the part (.csv, or .brdf in Cornell's text format). For several parts, prints a table")
      .required();
  command
      .add_input("--reference", options->reference,
                 "Measurements of the reference. Directions that only the part has are compared with a prediction, "
                 "which is less certain")
      .required();
  add_measurement_options(command, options->reading);
  add_noise_options(command, *options);
  command
      .add_option("--tolerance", options->tolerance,
                  "Largest allowed relative difference (0.05 is 5 %): one number, or one for each channel")
      .check(check::range(0.0, 10.0));
  command
      .add_option(
          "--peak-tolerance", options->peak_tolerance,
          "Largest allowed relative difference of highlights, where the half vector is within 5 degrees of the normal")
      .check(check::range(0.0, 10.0));
  command
      .add_option("--delta-e", options->delta_e,
                  "Instead of --tolerance: largest allowed colour difference of a direction (Delta E of CIELAB 1976 "
                  "under D65, of reflectance factors)")
      .check(check::range(0.0, 100.0));
  command
      .add_option("--false-alarms", options->question.false_alarms,
                  "Share of conforming parts that are reported as different")
      .check(check::range(1e-9, 0.5))
      .capture_default_str();
  command
      .add_option("--same-within", options->same_within,
                  "Directions count as the same if light and viewer, turned about the normal or swapped, differ by at "
                  "most this, in degrees")
      .check(check::range(0.0, 5.0))
      .capture_default_str();
  add_prior_option(command, options->prior);
  add_report_option(command, options->report, words);
  command.add_flag("--verbose", options->question.is_verbose,
                   "Print every direction that differs, and whether the prior's materials explain the part");
  command.add_flag("--json", options->print_json, "Print the answer and all directions as JSON");
  add_threads_option(command, options->threads);
  command.callback([options] {
    if (!check_or_refuse(*options)) throw negative_answer{};
  });
}

}  // namespace cli
