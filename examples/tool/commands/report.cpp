/// gonio report: completes samples and writes a page for people.

#include "commands.hpp"
#include "tool/files/file_kinds.hpp"
#include "tool/files/measurement_files.hpp"
#include "tool/options/reconstruct_choice.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/elapsed_time.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/page_pdf.hpp"
#include "tool/pages/report_data.hpp"
#include "tool/pages/report_page.hpp"
#include "tool/pages/warning.hpp"

#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace cli {

namespace {

/// The largest number of files in one chart: more colours and symbols could not be told apart.
constexpr std::size_t most_measurements = 6;

struct report_options {
  std::vector<std::filesystem::path> samples;
  reconstruct_options fit;  ///< without its samples
  page_option page;
  std::filesystem::path truth;
  std::string title;
};

/// Returns the names of the files in a page: their stems or, if two are equal, their paths.
std::vector<std::string> names_of(const std::vector<std::filesystem::path>& files) {
  std::set<std::string> stems;
  for (const auto& file : files) stems.insert(file.stem().string());
  std::vector<std::string> names;
  for (const auto& file : files) names.push_back(stems.size() == files.size() ? file.stem().string() : file.string());
  return names;
}

/// One of the measured files. All files are read before the first is reconstructed, so that a fault in any file is
/// reported at once.
struct fitted_file {
  std::string name;
  reconstruct_options options;
  gonio::io::sample_file measured;

  fitted_file(std::string called, const std::filesystem::path& file, const reconstruct_options& usual)
      : name(std::move(called)), options(usual), measured(read_colour_file(file, usual.reading)) {
    options.samples = file;
  }

  /// Reconstructs, and prints the result. `said_of` stands before each sentence.
  [[nodiscard]] reconstruction fit(const std::string& said_of) const {
    reconstruction found = reconstruct(options, measured.samples);
    for (const std::string& sentence : found.warnings) warn(said_of + sentence);
    std::cout << said_of << counted(std::ssize(measured.samples), "sample") << ", " << found.sentence << '\n';
    return found;
  }
};

void require_sensible(const report_options& options) {
  if (lower_extension(options.page.path) == ".pdf") (void)chromium_for(options.page.path);
  const std::size_t files = options.samples.size();
  if (files > most_measurements)
    gonio::refuse({"a page shows at most ", most_measurements, " files of samples, not ", files});
  if (files > 1 && !options.truth.empty())
    gonio::refuse({"--truth needs one file of samples, not ", files, ": the viewer shows the truth beside one fit"});
}

void write_report(const report_options& options) {
  require_sensible(options);
  const std::vector<std::string> names = names_of(options.samples);
  std::vector<fitted_file> files;
  for (std::size_t i = 0; i < names.size(); ++i) files.emplace_back(names[i], options.samples[i], options.fit);
  std::optional<gonio::brdf_table> truth;
  if (!options.truth.empty()) truth = read_table(options.truth);

  const fitted_file& subject = files.front();
  const bool is_alone = files.size() == 1;
  const reconstruction found = subject.fit(is_alone ? "" : subject.name + ": ");
  json data = [&] {
    const elapsed_time waiting("drawing " + options.page.path.string());
    return report_data({subject.options, subject.measured, found, truth ? &*truth : nullptr});
  }();
  std::string heading = data["name"].text();
  if (!is_alone) {
    data["subject"] = subject.name;
    heading = subject.name + " beside ";
  }
  for (std::size_t i = 1; i < files.size(); ++i) {
    const reconstruction other = files[i].fit(files[i].name + ": ");
    add_measurement(data, files[i].name, {files[i].options, files[i].measured, other, nullptr});
    heading += (i > 1 ? ", " : "") + files[i].name;
  }
  data["name"] = options.title.empty() ? heading : options.title;
  write_report_page(options.page, data);
}

}  // namespace

void add_report(command& app, const std::vector<std::string>& words) {
  auto command = app.add_subcommand(
      "report",
      "Complete a BRDF from samples and write a page that shows it, how sure it is, and which samples disagree");
  const auto options = std::make_shared<report_options>();
  command
      .add_input(
          "samples", options->samples,
          "One to six files of measurements (.csv, or a format that gonio reconstruct reads). The page describes the "
          "first file; its plots and its table of readings also show the others")
      .required();
  command
      .add_output(
          "-o,--output", options->page.path, {".html", ".pdf"},
          "Page to write: .html, one file that a browser shows without a network; or .pdf, which needs chromium "
          "on the PATH")
      .required();
  command.add_option("--title", options->title, "Heading of the page (default: the name of the file)");
  command.add_input("--truth", options->truth,
                    "Table that the viewer shows beside the fit of one file (.binary, .binary.gz, .npy, .bsdf or "
                    ".mbsdf): the truth, or another material");
  add_measurement_options(command, options->fit.reading);
  add_aperture_options(command, options->fit.reading.aperture);
  add_prior_option(command, options->fit.materials.prior);
  command.add_option("--noise", options->fit.noise, "Relative deviation of the measured values (0.02 is 2 %)")
      .check(check::range(0.0, 1.0));
  add_threads_option(command, options->fit.threads);
  options->page.command_line = words;
  command.callback([options] {
    options->fit.keeps_uncertainty = options->fit.keeps_residuals = true;
    write_report(*options);
  });
}

}  // namespace cli
