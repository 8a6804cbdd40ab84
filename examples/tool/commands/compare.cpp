/// gonio compare: the errors of an estimate.

#include "commands.hpp"
#include "tool/files/file_kinds.hpp"
#include "tool/files/radiance_image.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/measures_as_json.hpp"
#include <gonio/evaluate/appearance_metric.hpp>
#include <gonio/evaluate/comparison.hpp>
#include <gonio/evaluate/sphere_delta_e.hpp>
#include <gonio/model/instrument_readings.hpp>
#include <gonio/render/environment_map.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

namespace cli {

namespace {

struct compare_options {
  std::filesystem::path estimate, truth, prior, environment;
  bool print_json = false;
  gonio::thread_count threads;
};

/// Returns the mean Delta E of spheres in an environment, at the truth's exposure.
double delta_e_under(const std::filesystem::path& environment, const gonio::brdf_table& estimate,
                     const gonio::brdf_table& truth, gonio::thread_count threads) {
  const gonio::render::environment_map map(read_radiance(environment));
  const gonio::sphere_delta_e delta_e(truth.cells(), gonio::render::environment_lighting(90, 72, map), 36,
                                      gonio::sphere_delta_e::middle_grey, threads);
  if (estimate.cells() == truth.cells()) return delta_e.difference(estimate, truth, threads);
  return delta_e.difference(resample(estimate, truth.cells(), threads), truth, threads);
}

/// Prints the readings of instruments on the estimate and on the truth.
void print(const gonio::model::instrument_readings& estimate, const gonio::model::instrument_readings& truth) {
  const auto line = [](const char* what, double of_estimate, double of_truth, int digits, const std::string& unit) {
    std::cout << what << fixed(of_estimate, digits) << " instead of " << fixed(of_truth, digits) << unit << '\n';
  };
  for (std::size_t i = 0; i < truth.gloss.size(); ++i)
    line("gloss             ", estimate.gloss[i], truth.gloss[i], 1,
         " units at " + std::to_string(gonio::model::gloss_angles[i]) + " degrees, ISO 2813");
  line("haze              ", estimate.haze, truth.haze, 1, " units at 20 degrees, ISO 13803");
  line("reflectance       ", gonio::luminance(estimate.total), gonio::luminance(truth.total), 3,
       " of light at 8 degrees, specular included");
  double largest = 0.0;
  for (std::size_t i = 0; i < truth.colours.size(); ++i)
    largest = std::max(largest, std::sqrt((estimate.colours[i].lab - truth.colours[i].lab).square().sum()));
  std::cout << "multi-angle       " << fixed(largest, 2)
            << "   the largest Delta E at 15 to 110 degrees from the mirror direction, light at 45\n";
}

void print(const gonio::comparison& errors, std::optional<double> natural) {
  const auto line = [](const char* what, const std::string& value) { std::cout << what << value << '\n'; };
  line("mapped rms        ", fixed(errors.mapped_rms.mean(), 4) + "   in the prior's domain (log-relative)");
  line("cosine rms        ",
       fixed(errors.cosine_rms.mean(), 4) + "   sr^-1, values weighted by max(cos_i cos_o, 0.001)");
  line("Delta E, lights   ", fixed(errors.delta_e_lights, 2) + "   CIELAB 1976, sphere under two lights");
  line("Delta E, env      ", fixed(errors.delta_e_env, 2) + "   CIELAB 1976, sphere under the closed-form environment");
  if (natural)
    line("Delta E, natural  ",
         fixed(*natural, 2) + "   under --environment, exposed so that the true sphere is middle grey");
  line("peak ratio        ",
       fixed(errors.peak_ratio.mean(), 3) + "   99.9th percentile over theta_h < 5, theta_d <= 70 degrees");
  line("spheres: sRGB, D65, exposed so that a white Lambertian sphere has mean luminance 1", "");
}

void compare_tables(const compare_options& options) {
  const auto truth = read_table(options.truth, options.threads);
  const auto estimate = read_table(options.estimate, options.threads);
  const auto prior = read_prior(options.prior);
  const gonio::appearance_metric appearance(truth.cells(), 36, options.threads);
  const auto errors = gonio::compare(estimate, truth, prior.metric(), appearance, options.threads);
  std::optional<double> natural;
  if (!options.environment.empty()) natural = delta_e_under(options.environment, estimate, truth, options.threads);
  const auto of_estimate = gonio::model::read_instruments(estimate), of_truth = gonio::model::read_instruments(truth);
  if (!options.print_json) {
    print(errors, natural);
    return print(of_estimate, of_truth);
  }
  json printed = to_json(errors);
  printed["readings"] = {{"estimate", to_json(of_estimate)}, {"truth", to_json(of_truth)}};
  if (natural) printed["delta_e_natural"] = *natural;
  std::cout << printed.dump(2) << '\n';
}

}  // namespace

void add_compare(command& app) {
  auto command = app.add_subcommand("compare", "Measure the errors of an estimated table");
  const auto options = std::make_shared<compare_options>();
  command.add_input("estimate", options->estimate, "Estimated table (.binary, .binary.gz, .npy, .bsdf or .mbsdf)")
      .required();
  command.add_input("truth", options->truth, "True table (.binary, .binary.gz, .npy, .bsdf or .mbsdf)").required();
  add_prior_option(command, options->prior);
  command.add_input(
      "--environment", options->environment,
      "Latitude-longitude image of a natural environment, for a further Delta E (" + radiance_formats() + ")");
  command.add_flag("--json", options->print_json, "Print the errors as JSON");
  add_threads_option(command, options->threads);
  command.callback([options] { compare_tables(*options); });
}

}  // namespace cli
