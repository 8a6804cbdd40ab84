/// gonio report: samples in, a page for people out.

#include "command_line/fixed.hpp"
#include "command_line/measurement_files.hpp"
#include "command_line/prior_option.hpp"
#include "command_line/reconstruct_choice.hpp"
#include "command_line/report_page.hpp"
#include "command_line/threads_option.hpp"
#include "command_line/warning.hpp"
#include "commands.hpp"
#include "report_data.hpp"
#include <gonio/io/file.hpp>
#include <gonio/io/merl_gzip.hpp>
#include <gonio/io/prior.hpp>

#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

namespace cli {

namespace {

struct report_options {
  reconstruct_options fit;
  std::filesystem::path page, truth;
  std::string title;
};

/// The command line as a shell takes it.
std::string as_typed(const std::vector<std::string>& words) {
  constexpr std::string_view plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-./=,:+@%";
  std::string line = "gonio";
  for (const std::string& word : std::span(words).subspan(std::min<std::size_t>(1, words.size()))) {
    line += ' ';
    if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) {
      line += word;
      continue;
    }
    line += '\'';
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

/// What was done, as pairs of a name and a text.
json record_of(const reported_fit& fit, const std::vector<std::string>& words) {
  const auto& [options, measured, found, truth] = fit;
  json record = json::array();
  const auto add = [&](const char* name, const std::string& text) {
    if (!text.empty()) record.push_back(json::array({name, text}));
  };
  add("Command", as_typed(words));
  add("Version", "gonio " GONIO_VERSION);
  add("Samples", options.samples.string() + ": " + std::to_string(measured.samples.size()) + ", of which " +
                     std::to_string(counting_samples(measured.samples).size()) + " count");
  add("Quantity", std::string(measured.quantity ? name_of(*measured.quantity) : "brdf") +
                      (measured.wavelength ? ", at " + fixed(*measured.wavelength, 1) + " nm" : ""));
  add("Instrument", measured.provenance.instrument);
  add("Date", measured.provenance.date);
  add("Conditions", measured.provenance.conditions);
  const gonio::log_relative_pca prior = gonio::io::read_prior(options.materials.prior);
  add("Prior", options.materials.prior.string() + ": " + std::to_string(prior.size()) + " components of " +
                   std::to_string(prior.names().size()) + " materials");
  add("Method", "principal components and a discrepancy of variance " + fixed(options.discrepancy, 3) +
                    ", which takes the place of a penalty eta");
  add("Noise", options.noise ? fixed(100.0 * *options.noise, 2) + " % (stated)" : "not stated");
  add("Residual", found.sentence);
  return record;
}

void write_report(const report_options& options, const std::vector<std::string>& words) {
  const gonio::io::sample_file measured = read_measurement_file(options.fit.samples, options.fit.reading);
  std::optional<gonio::brdf_table> truth;
  if (!options.truth.empty()) truth = gonio::io::read_merl_any(options.truth);
  const reconstruction found = reconstruct(options.fit, measured.samples);
  const reported_fit fit{options.fit, measured, found, truth ? &*truth : nullptr};
  json data = report_data(fit);
  if (!options.title.empty()) data["name"] = options.title;
  data["record"] = record_of(fit, words);
  const std::string page = report_page(data["name"].text(), data);
  gonio::io::write_atomically(options.page, std::as_bytes(std::span(page)));
  for (const std::string& sentence : found.warnings) warn(sentence);
  std::cout << measured.samples.size() << " samples, " << found.sentence << '\n';
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
      .add_output("-o,--output", options->page, {".html"},
                  "Page to write (.html): one file, which a browser shows without a network")
      .required();
  command.add_option("--title", options->title, "Heading of the page (default: the name of the file)");
  command.add_input(
      "--truth", options->truth,
      "Table that the viewer shows beside the fit (.binary or .binary.gz): the truth, or another material");
  add_measurement_options(command, options->fit.reading);
  add_prior_option(command, options->fit.materials.prior);
  command.add_option("--noise", options->fit.noise, "Relative deviation of the measured values (0.02 is 2 %)")
      .check(check::range(0.0, 1.0));
  add_threads_option(command, options->fit.threads);
  command.callback([options, words] {
    options->fit.keeps_uncertainty = options->fit.keeps_residuals = true;
    write_report(*options, words);
  });
}

}  // namespace cli
