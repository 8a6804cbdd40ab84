/// gonio report: completes samples and writes a page for people.

#include "commands.hpp"
#include "tool/files/measurement_files.hpp"
#include "tool/options/reconstruct_choice.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/elapsed_time.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/report_data.hpp"
#include "tool/pages/report_page.hpp"
#include "tool/pages/warning.hpp"
#include <gonio/io/materials/merl_gzip.hpp>

#include <iostream>
#include <memory>
#include <optional>

namespace cli {

namespace {

struct report_options {
  reconstruct_options fit;
  page_option page;
  std::filesystem::path truth;
  std::string title;
};

void write_report(const report_options& options) {
  const gonio::io::sample_file measured = read_colour_file(options.fit.samples, options.fit.reading);
  std::optional<gonio::brdf_table> truth;
  if (!options.truth.empty()) truth = gonio::io::read_merl_any(options.truth);
  const reconstruction found = reconstruct(options.fit, measured.samples);
  const reported_fit fit{options.fit, measured, found, truth ? &*truth : nullptr};
  auto waiting = std::make_unique<elapsed_time>("drawing " + options.page.path.string());
  json data = report_data(fit);
  if (!options.title.empty()) data["name"] = options.title;
  write_report_page(options.page, data);
  waiting.reset();
  for (const std::string& sentence : found.warnings) warn(sentence);
  std::cout << counted(std::ssize(measured.samples), "sample") << ", " << found.sentence << '\n';
}

}  // namespace

void add_report(command& app, const std::vector<std::string>& words) {
  auto command = app.add_subcommand(
      "report",
      "Complete a BRDF from samples and write a page that shows it, how sure it is, and which samples disagree");
  const auto options = std::make_shared<report_options>();
  command.add_input("samples", options->fit.samples, "Measurements (.csv, or a format that gonio reconstruct reads)")
      .required();
  command
      .add_output("-o,--output", options->page.path, {".html"},
                  "Page to write (.html): one file, which a browser shows without a network")
      .required();
  command.add_option("--title", options->title, "Heading of the page (default: the name of the file)");
  command.add_input(
      "--truth", options->truth,
      "Table that the viewer shows beside the fit (.binary or .binary.gz): the truth, or another material");
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
