/// gonio convert: writes a file as another kind of file.

#include "commands.hpp"
#include "tool/files/file_kinds.hpp"
#include "tool/files/measurement_files.hpp"
#include "tool/options/albedo_tolerance_option.hpp"
#include "tool/options/threads_option.hpp"
#include <gonio/core/error.hpp>
#include <gonio/io/text/text.hpp>

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <memory>
#include <string_view>

namespace cli {

namespace {

struct convert_options {
  std::filesystem::path input, output;
  measurement_options reading;
  writing how;
};

void convert(const convert_options& options) {
  // Refuse wrong options before reading the input, which may take hours.
  const file_kind& kind = written_kind(options.output);
  const auto needs = [&](bool asked, const char* option, std::initializer_list<std::string_view> endings) {
    if (!asked || std::ranges::find(endings, kind.extensions.front()) != endings.end()) return;
    gonio::refuse({option, " needs an output that ends in ",
                   gonio::io::listed({endings.begin(), endings.size()}, " or "), ", not ", options.output.native()});
  };
  needs(options.how.as_spectra, "--spectra", {".bsdf"});
  needs(options.how.as_zemax, "--zemax", {".bsdf"});
  needs(options.how.polar_steps != 0, "--polar-steps", {".mbsdf", ".xompt"});
  needs(options.how.as_halves, "--half", {".npy"});
  needs(options.how.keeps_negative, "--keep-negative", {".bsdf", ".mbsdf", ".xompt"});
  require_bsdf(options.how.albedo_tolerance, options.output);
  write_file(options.output, read_file_for(options.output, options.input, options.reading), options.how);
}

}  // namespace

void add_convert(command& app) {
  auto command =
      app.add_subcommand("convert", "Convert a file to another format: tables, materials for renderers, samples");
  const auto options = std::make_shared<convert_options>();
  command
      .add_input(
          "input", options->input,
          "Table (.binary, .binary.gz or .npy), RGL material or Zemax's table (.bsdf), MDL measurement (.mbsdf), "
          "material of UTIA's database (.bin) or samples (.csv, or an instrument's format), recognised by its "
          "first bytes or else its extension")
      .required();
  add_measurement_options(command, options->reading);
  options->reading.takes_anisotropic = true;
  command
      .add_output("output", options->output, {},
                  "Table (.binary or .npy), RGL material for Mitsuba and pbrt (.bsdf), measured BSDF of NVIDIA's MDL "
                  "(.mbsdf), OpenMATERIAL table (_brdf.xompt), or samples (.csv)")
      .required();
  auto zemax = command.add_flag("--zemax", options->how.as_zemax,
                                "For .bsdf: write a table in Zemax's format, with rotations of the sample if the "
                                "material is anisotropic");
  command
      .add_flag("--spectra", options->how.as_spectra,
                "For .bsdf: write spectra instead of RGB, for pbrt-v4 and the spectral variants of Mitsuba. A "
                "material in RGB gets smooth spectra of the same colour")
      .excludes(zemax);
  command
      .add_option("--polar-steps", options->how.polar_steps,
                  "For .mbsdf or .xompt: number of steps of each polar angle up to 90 degrees. The azimuth has twice "
                  "as many, up to 180 degrees (.mbsdf) or 360 (.xompt). Default: 18 for .xompt; for .mbsdf, the steps "
                  "of theta_d and phi_d of a table, or 90")
      .check(check::range(2, 360));
  add_albedo_tolerance_option(command, options->how.albedo_tolerance);
  command.add_flag("--half", options->how.as_halves,
                   "For .npy: write half floats (11 bits, at most 65504) instead of float32");
  command.add_flag("--keep-negative", options->how.keeps_negative,
                   "For .bsdf, .mbsdf or .xompt: keep negative values instead of writing 0. A renderer subtracts them "
                   "from other light");
  add_threads_option(command, options->how.threads);
  command.callback([options] { convert(*options); });
}

}  // namespace cli
