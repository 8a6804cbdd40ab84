/// gonio reconstruct: completes samples to a table over all directions.

#include "commands.hpp"
#include "tool/files/file_kinds.hpp"
#include "tool/files/file_start.hpp"
#include "tool/files/json.hpp"
#include "tool/files/measurement_files.hpp"
#include "tool/options/albedo_tolerance_option.hpp"
#include "tool/options/materials.hpp"
#include "tool/options/reconstruct_choice.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/images.hpp"
#include "tool/pages/report_data.hpp"
#include "tool/pages/report_page.hpp"
#include "tool/pages/uncertainty_image.hpp"
#include "tool/pages/warning.hpp"
#include <gonio/io/bytes/file.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <iostream>
#include <memory>
#include <optional>
#include <span>

namespace cli {

namespace {

/// Writes a line for each round; docs/reference/formats.md describes the columns.
void write_history(const std::filesystem::path& path, std::span<const gonio::correction_round> rounds) {
  std::string text = "round,error,change,down_weighted\n";
  const auto append = [&](double value, char separator) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    text.append(digits.data(), end).push_back(separator);
  };
  for (std::size_t i = 0; i < rounds.size(); ++i) {
    text += std::to_string(i + 1) + ',';
    append(rounds[i].error, ',');
    append(rounds[i].change, ',');
    append(rounds[i].down_weighted, '\n');
  }
  gonio::io::write_atomically(path, std::as_bytes(std::span(text)));
}

void print(const reconstruction& result, const gonio::io::sample_file& measured, bool as_json) {
  for (const std::string& sentence : result.warnings) warn(sentence);
  if (as_json) {
    json all{{"samples", measured.samples.size()}};
    all.update(facts_of(measured));
    all.update(result.details);
    std::cout << all.dump(2) << '\n';
    return;
  }
  std::cout << counted(std::ssize(measured.samples), "sample") << (result.sentence.empty() ? "" : ", ")
            << result.sentence << '\n';
}

void write_sphere(const reconstruct_options& options, const gonio::brdf_table& table, const image_options& how) {
  std::array spheres{sphere_image(table, how, options.threads)};
  expose_spheres(spheres, how);
  gonio::io::write_png(options.image, spheres.front());
}

/// Writes spectra if the format holds them, else the table.
void write_result(const reconstruct_options& options, const reconstruction& result) {
  const writing how{.albedo_tolerance = options.albedo_tolerance, .threads = options.threads};
  if (lower_extension(options.output) != ".bsdf" || !result.spectra)
    return write_file(options.output, result.table, how);
  write_spectra(options.output, *result.spectra, options.output.stem().string(), how);
}

/// Returns the samples in the channels to fit. Keeps wavelengths if requested, or if the output can hold them.
gonio::io::sample_file read_fitted(reconstruct_options& options) {
  gonio::io::sample_file measured = read_measurement_file(options.samples, options.reading);
  const gonio::channels& kinds = measured.samples.channels();
  if (options.fits_spectra && kinds.wavelengths().empty())
    gonio::refuse({options.samples.native(), ": has no wavelengths, but --spectra needs them"});
  const bool is_bsdf = lower_extension(options.output) == ".bsdf";
  if (is_bsdf && options.fits_spectra && !kinds.are_wavelengths())
    gonio::refuse({options.output.native(), ": spectra need at least two wavelengths: omit --spectra"});
  const bool wants_colours = options.reading.light.has_value();
  if (is_bsdf && kinds.are_wavelengths() && takes_spectra(options.method) && !wants_colours)
    options.fits_spectra = true;
  if (!options.fits_spectra)
    static_cast<void>(as_colours(options.samples, measured.samples));  // refuses invisible ones
  options.provenance = measured.provenance;
  return measured;
}

bool writes_nothing(const reconstruct_options& options) {
  const auto files = {
      &options.output,           &options.image,    &options.uncertainty, &options.uncertainty_image, &options.history,
      &options.iteration_figure, &options.residuals};
  return std::ranges::all_of(files, [](const auto* file) { return file->empty(); }) && !options.report.is_given() &&
         !options.print_json;
}

void reconstruct_and_write(reconstruct_options options, const image_options& how) {
  gonio::io::sample_file measured = read_fitted(options);
  const reconstruction result = reconstruct(options, measured.samples);
  if (measured.samples.channels().are_wavelengths()) measured.samples = measured.samples.in_three_channels();
  if (!options.output.empty()) write_result(options, result);
  if (!options.image.empty()) write_sphere(options, result.table, how);
  if (!options.uncertainty.empty()) write_table(options.uncertainty, *result.uncertainty);
  if (!options.uncertainty_image.empty())
    gonio::io::write_png(options.uncertainty_image,
                         uncertainty_image(result.table, *result.uncertainty, how.size, options.threads));
  if (!options.history.empty()) write_history(options.history, result.history);
  if (result.iteration_figure) {
    gonio::io::write_png(options.iteration_figure / "iterations.png", *result.iteration_figure);
    write_history(options.iteration_figure / "history.csv", result.history);
  }
  if (options.report.is_given()) write_report_page(options.report, report_data({options, measured, result, nullptr}));
  if (writes_nothing(options)) warn("no file is written: -o FILE writes the table");
  print(result, measured, options.print_json);
}

void add_method_option(command& to, std::string& name) {
  std::string description;
  std::vector<std::string> names;
  for (const reconstruct_method& m : reconstruct_methods()) {
    description += (names.empty() ? "" : "; ") + std::string(m.name) + ": " + m.description;
    names.emplace_back(m.name);
  }
  to.add_option("--method", name, description).check(check::one_of(names)).capture_default_str();
}

void add_correction_options(command& to, reconstruct_options& options) {
  to.add_option("--gamma", options.gamma,
                "With --method correction: how fast the weight of a sample decreases with its relative deviation (0: "
                "all samples have equal weights; the paper mostly uses 3), or auto")
      .capture_default_str();
  to.add_flag("--as-printed", options.as_printed,
              "With --method correction: follow Noell et al. 2014 exactly, with their weights, without constant "
              "function and without inertia. --gamma is then 3 by default (the paper has 0 without outliers, 3 if a "
              "fifth of the samples are outliers, 6 for more)");
  to.add_option("--iterations", options.iterations, "With --method correction: largest number of rounds")
      .check(check::range(1, 10'000))
      .capture_default_str();
  to.add_output("--history", options.history, {".csv"},
                "With --method correction: table of the rounds to write (.csv)");
  to.add_output_folder("--iteration-figure", options.iteration_figure, {"iterations.png", "history.csv"},
                       "With --method correction: folder to write, with an image of the first rounds and the last, and "
                       "the history of all rounds");
  to.add_input("--truth", options.truth,
               "True table that --iteration-figure compares with (.binary, .binary.gz, .npy, .bsdf or .mbsdf)");
  to.add_option("--seed", options.seed,
                "Seed of the centres of --method rbf, and of the initial samples of --method correction")
      .capture_default_str();
}

void add_spectra_options(command& to, reconstruct_options& options) {
  to.add_flag("--spectra", options.fits_spectra,
              "Fit each wavelength of spectral samples (.csv with columns like 400nm, or instruments' formats) as a "
              "grey material. Default if -o is a .bsdf, which then holds spectra; other formats hold colours");
  to.add_choice(
      "--illuminant", [&options](int light) { options.reading.light = static_cast<gonio::illuminant>(light); },
      {{"D65", static_cast<int>(gonio::illuminant::d65)}, {"A", static_cast<int>(gonio::illuminant::a)}},
      "Light under which spectra become colours: D65, daylight (the default), or A, incandescent");
}

}  // namespace

void add_reconstruct(command& app, const std::vector<std::string>& words) {
  auto command = app.add_subcommand("reconstruct", "Complete a BRDF from samples");
  const auto options = std::make_shared<reconstruct_options>();
  const auto how = std::make_shared<image_options>();
  // Declare the samples and the method.
  command.add_input("samples", options->samples, "Measurements (.csv, or .brdf in Cornell's text format)").required();
  add_measurement_options(command, options->reading);
  add_aperture_options(command, options->reading.aperture);
  add_spectra_options(command, *options);
  add_method_option(command, options->method);
  add_prior_option(command, options->materials.prior);
  add_material_options(command, options->materials);
  // Declare the metric, the solver and the noise.
  command
      .add_option("--metric", options->metric,
                  "Error metric of the methods linear and rbf, and of the start of the method correction: lin, root, "
                  "log (ln(1 + x), the default) or log-relative")
      .check(check::one_of({"lin", "root", "log", "log-relative"}));
  command.add_option("--root", options->root, "With --metric root: degree of the root").capture_default_str();
  add_solver_options(command, options->solver);
  command.add_option("--noise", options->noise,
                     "Relative deviation of the measured values (0.02 is 2 %). Sets the penalty of --method pca");
  command
      .add_option("--discrepancy", options->discrepancy,
                  "With --method pca: variance, in the metric's domain, of the discrepancy, which is the detail that "
                  "the components do not have. 0: components alone, with a penalty chosen by cross-validation")
      .check(check::range(0.0, 10.0))
      .capture_default_str();
  command.add_flag("--no-reject", options->keeps_all,
                   "Give all samples their full weight. By default, --method pca rejects samples that contradict the "
                   "other samples, and names the worst");
  command.add_output("--residuals", options->residuals, {".csv"},
                     "Table to write (.csv): for each sample, the value that all other samples predict");
  command.add_output(
      "--uncertainty", options->uncertainty, {".binary", ".npy"},
      "Table to write of the relative standard deviation of each direction: 0.06 is 6 % (68 of 100 cases)");
  command.add_output("--uncertainty-image", options->uncertainty_image, {".png"},
                     "Image of a sphere to write (.png), coloured by the relative uncertainty of its brightness, "
                     "logarithmically: light up to 2 %, dark blue from 100 %");
  add_report_option(command, options->report, words);
  // Declare the corrections.
  add_correction_options(command, *options);
  command
      .add_option("--misplaced", options->angular_error,
                  "Error of the directions of light and of viewer, in degrees. Samples on the flanks of highlights "
                  "then count less (for images: gonio near-field --misplaced)")
      .capture_default_str();
  command
      .add_option("--neighbours", options->neighbours, "With --method scattered: number of nearest samples to average")
      .check(check::range(1, static_cast<int>(gonio::scattered_options::most_neighbours)))
      .capture_default_str();
  // Declare the output.
  command.add_output("-o,--output", options->output, {".binary", ".npy", ".bsdf", ".mbsdf"},
                     "Table to write (.binary, .npy, or .bsdf or .mbsdf for renderers)");
  add_albedo_tolerance_option(command, options->albedo_tolerance);
  auto image = command.add_output("--image", options->image, {".png"}, "Image of a sphere to write (.png)");
  add_image_options(command, *how, image);
  command.add_flag("--json", options->print_json, "Print the result of the fit as JSON");
  add_threads_option(command, options->threads);
  command.help_with({"--noise", "-o", "--quantity", "--columns", "--theta-o-sign", "--spectra", "--method", "--prior",
                     "--no-reject", "--residuals", "--uncertainty", "--uncertainty-image", "--report", "--image",
                     "--json", "--threads"});
  // Refuse options that the method does not take, then run the method.
  command.callback([command, options, how] {
    take_given(*options, [&](const std::string& option) { return command.count(option) > 0; });
    if (command.count("--truth") > 0 && command.count("--iteration-figure") == 0)
      gonio::refuse("--truth needs --iteration-figure");
    require_bsdf(options->albedo_tolerance, options->output);
    reconstruct_and_write(*options, *how);
  });
}

}  // namespace cli
