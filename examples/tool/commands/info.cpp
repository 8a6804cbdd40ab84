/// gonio info: describes the content of a file.

#include "commands.hpp"
#include "tool/files/described_files.hpp"
#include "tool/files/json.hpp"
#include "tool/options/prior_material.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/component_figure.hpp"
#include <gonio/basis/component_variance.hpp>
#include <gonio/basis/pca.hpp>
#include <gonio/core/printable.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/io/text/text.hpp>

#include <iostream>
#include <memory>

namespace cli {

namespace {

struct info_options {
  std::filesystem::path file, components, component_spheres;
  std::string weights_of;
  measurement_options reading;
  Eigen::Index count = 5;
  int size = 128;
  bool print_json = false;
  gonio::thread_count threads;

  /// Do the options need a prior?
  [[nodiscard]] bool asks_for_prior() const {
    return !components.empty() || !component_spheres.empty() || !weights_of.empty();
  }
};

json array_of(const Eigen::VectorXd& values) { return std::vector<double>(values.begin(), values.end()); }

/// Returns the weights of one of the prior's materials, in the form of --weights of gonio expand.
json weights_of(const gonio::log_relative_pca& prior, const info_options& options) {
  const Eigen::MatrixXd weights = prior.weights_of(material_number(prior, options.weights_of, options.file));
  if (prior.wavelengths().empty())
    return {{"r", array_of(weights.col(0))}, {"g", array_of(weights.col(1))}, {"b", array_of(weights.col(2))}};
  json all;
  for (Eigen::Index band = 0; band < prior.channels(); ++band)
    all[gonio::io::shortest(prior.wavelengths()[band]) + "nm"] = array_of(weights.col(band));
  return all;
}

/// Rounds to four decimals, for people.
json rounded(const Eigen::VectorXd& values) { return array_of((1e4 * values).array().round() / 1e4); }

/// Draws the components of a prior, and returns what the images show.
json describe_components(const gonio::log_relative_pca& prior, const info_options& options) {
  if (options.count > prior.size())
    gonio::refuse({"--count ", options.count, ": ", options.file.native(), " has ", prior.size(), " components"});
  json facts{{"shares_of_variance", rounded(gonio::variance_shares(prior).head(options.count))},
             {"deviations_of_weights", array_of(gonio::weight_deviations(prior.coefficients()).head(options.count))}};
  if (!options.components.empty()) {
    const auto figure = draw_component_slices(prior, options.count, options.size, options.threads);
    gonio::io::write_png(options.components, figure.image);
    facts["pure_red_stands_for"] =
        rounded(Eigen::Map<const Eigen::VectorXd>(figure.limits.data(), std::ssize(figure.limits)));
  }
  if (!options.component_spheres.empty())
    gonio::io::write_png(options.component_spheres,
                         draw_component_spheres(prior, options.count, options.size, options.threads));
  return facts;
}

json describe_prior(const info_options& options) {
  const auto prior = read_prior(options.file);
  json facts = describe(prior);
  if (!options.weights_of.empty()) facts["weights"] = weights_of(prior, options);
  if (!options.components.empty() || !options.component_spheres.empty())
    facts.update(describe_components(prior, options));
  return facts;
}

json describe_asked(const info_options& options) {
  if (!options.asks_for_prior()) return describe_file(options.file, options.reading);
  require_unused(options.reading, options.file);
  return describe_prior(options);
}

void print(const json& facts) {
  for (const auto& [key, value] : facts.items())
    std::cout << key << ": " << gonio::printable(value.is_string() ? value.text() : value.dump()) << '\n';
}

}  // namespace

void add_info(command& app) {
  auto command = app.add_subcommand("info",
                                    "Describe any file that gonio reads or writes: number of samples or cells, ranges "
                                    "of angles, repeats, suspicious values");
  const auto options = std::make_shared<info_options>();
  command.add_input("file", options->file, "File to describe").required();
  add_measurement_options(command, options->reading);
  options->reading.takes_anisotropic = true;
  command.add_output("--components", options->components, {".png"},
                     "For a prior: image to write (.png), slices at phi_d = 90 degrees (theta_h to the right, theta_d "
                     "upwards): the reference BRDF, then one standard deviation of each of the first components, from "
                     "blue to red on its own scale (Nielsen et al. 2015, Fig. 3)");
  command.add_output("--component-spheres", options->component_spheres, {".png"},
                     "For a prior: image to write (.png), spheres in a column for each of the first components, with "
                     "its weight at -2, -1, 0, 1 and 2 standard deviations from top to bottom");
  command.add_option("--count", options->count, "Number of components to draw")
      .check(check::positive_number())
      .capture_default_str();
  command.add_option("--size", options->size, "Rows and columns of each slice or sphere")
      .check(check::range(8, 1024))
      .capture_default_str();
  command.add_option("--weights-of", options->weights_of,
                     "For a prior: name of a material whose weights to print, in the form of gonio expand --weights");
  command.add_flag("--json", options->print_json, "Print as JSON");
  add_threads_option(command, options->threads);
  command.callback([command, options] {
    const bool draws = !options->components.empty() || !options->component_spheres.empty();
    if (!draws && command.count("--count") + command.count("--size") > 0)
      gonio::refuse("--count and --size need --components or --component-spheres");
    const json facts = describe_asked(*options);
    if (options->print_json)
      std::cout << facts.dump(2) << '\n';
    else
      print(facts);
  });
}

}  // namespace cli
