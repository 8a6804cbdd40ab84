/// gonio info: what a file holds.

#include "command_line/component_figure.hpp"
#include "command_line/json.hpp"
#include "command_line/measurement_files.hpp"
#include "command_line/measurement_kinds.hpp"
#include "command_line/measures_as_json.hpp"
#include "command_line/prior_material.hpp"
#include "command_line/threads_option.hpp"
#include "commands.hpp"
#include <gonio/basis/component_variance.hpp>
#include <gonio/basis/pca.hpp>
#include <gonio/core/printable.hpp>
#include <gonio/io/image.hpp>
#include <gonio/io/merl_gzip.hpp>
#include <gonio/io/networks.hpp>
#include <gonio/io/prior.hpp>
#include <gonio/io/soft_specular_prior.hpp>
#include <gonio/model/measured_properties.hpp>

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

  /// What only a prior has.
  [[nodiscard]] bool asks_for_prior() const {
    return !components.empty() || !component_spheres.empty() || !weights_of.empty();
  }
};

json describe(const gonio::valid_cells& cells) {
  const auto [theta_h, theta_d, phi_d] = cells.grid().extents();
  return {{"grid", {theta_h, theta_d, phi_d}},
          {"anchor", cells.grid().anchor() == gonio::cell_anchor::centre ? "centre" : "lower corner"},
          {"minimum_cosine", cells.minimum_cosine()},
          {"valid_cells", cells.size()}};
}

json describe(const gonio::brdf_table& table) {
  const gonio::model::table_values values = gonio::model::summarise(table);
  json result{{"kind", "MERL table"}};
  result.update(describe(table.cells()));
  result["minimum"] = per_channel(values.minimum);
  result["mean"] = per_channel(values.mean);
  result["maximum"] = per_channel(values.maximum);
  result["cells_with_negative_values"] = values.negative_cells;
  return result;
}

json describe(const gonio::log_relative_pca& prior) {
  json result{{"kind", "prior"},
              {"source", prior.source()},
              {"materials", prior.names().size()},
              {"components", prior.size()},
              {"explained_variance", prior.explained_variance()},
              {"cosine_weight", prior.metric().weighting() == gonio::cosine_weighting::larger ? "larger" : "product"}};
  result.update(describe(prior.cells()));
  result["names"] = prior.names();
  return result;
}

json describe(const gonio::soft_specular_prior& prior) {
  const auto half = [](const gonio::log_relative_pca& one) {
    return json{{"materials", one.names().size()},
                {"components", one.size()},
                {"explained_variance", one.explained_variance()},
                {"names", one.names()}};
  };
  json result{{"kind", "soft and specular prior"}, {"source", prior.soft().source()}, {"threshold", prior.threshold()}};
  result.update(describe(prior.cells()));
  result["soft"] = half(prior.soft());
  result["specular"] = half(prior.specular());
  return result;
}

json describe(const gonio::io::sample_file& measured) {
  const gonio::sample_set& samples = measured.samples;
  gonio::rgb low = samples.front().value, high = low;
  for (const gonio::sample& s : samples) {
    low = low.min(s.value);
    high = high.max(s.value);
  }
  json result{
      {"kind", "samples"}, {"samples", samples.size()}, {"minimum", per_channel(low)}, {"maximum", per_channel(high)}};
  result.update(facts_of(measured));
  return result;
}

json array_of(const Eigen::VectorXd& values) { return std::vector<double>(values.begin(), values.end()); }

/// The weights of one of its materials, as --weights of gonio expand takes them.
json weights_of(const gonio::log_relative_pca& prior, const info_options& options) {
  const Eigen::MatrixXd weights = prior.weights_of(material_number(prior, options.weights_of, options.file));
  return {{"r", array_of(weights.col(0))}, {"g", array_of(weights.col(1))}, {"b", array_of(weights.col(2))}};
}

/// To four decimals, for people.
json rounded(const Eigen::VectorXd& values) { return array_of((1e4 * values).array().round() / 1e4); }

/// Draws the components of a prior, and adds what the images mean.
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
  const auto prior = gonio::io::read_prior(options.file);
  json facts = describe(prior);
  if (!options.weights_of.empty()) facts["weights"] = weights_of(prior, options);
  if (!options.components.empty() || !options.component_spheres.empty())
    facts.update(describe_components(prior, options));
  return facts;
}

/// By what the file starts with or how its name ends.
json describe_file(const info_options& options) {
  const std::filesystem::path& path = options.file;
  if (options.asks_for_prior()) {
    require_unused(options.reading, path);
    return describe_prior(options);
  }
  const std::string name = path.filename().string();
  if (holds_measurements(path)) return describe(read_measurement_file(path, options.reading));
  require_unused(options.reading, path);
  if (name.ends_with(".npy")) {
    const auto networks = gonio::io::read_networks(path);
    return {{"kind", "networks"}, {"materials", networks.names.size()}, {"names", networks.names}};
  }
  if (gonio::io::is_prior(path)) return describe_prior(options);
  if (gonio::io::is_soft_specular_prior(path)) return describe(gonio::io::read_soft_specular_prior(path));
  return describe(gonio::io::read_merl_any(path));
}

void print(const json& facts) {
  for (const auto& [key, value] : facts.items())
    std::cout << key << ": " << gonio::printable(value.is_string() ? value.text() : value.dump()) << '\n';
}

}  // namespace

void add_info(command& app) {
  auto command = app.add_subcommand("info", "Say what a file holds: a table, a prior, samples, networks");
  const auto options = std::make_shared<info_options>();
  command.add_input("file", options->file, "The file").required();
  add_measurement_options(command, options->reading);
  command.add_output(
      "--components", options->components, {".png"},
      "Of a prior: image to write (.png) of slices at phi_d = 90 degrees, theta_h to the right and theta_d upwards: "
      "the reference BRDF, then what one standard deviation of each of the first components adds to the mapped "
      "reflectance, from blue (less) over white to red (more), each in a scale of its own (Nielsen et al. 2015, Fig. "
      "3)");
  command.add_output("--component-spheres", options->component_spheres, {".png"},
                     "Of a prior: image to write (.png) of spheres, a column for each of the first components, whose "
                     "weight is -2, -1, 0, 1 and 2 standard deviations from the top to the bottom");
  command.add_option("--count", options->count, "How many components are drawn")
      .check(check::positive_number())
      .capture_default_str();
  command.add_option("--size", options->size, "Rows and columns of each slice or sphere")
      .check(check::range(8, 1024))
      .capture_default_str();
  command.add_option("--weights-of", options->weights_of,
                     "Of a prior: the weights of one of its materials, as gonio expand --weights takes them");
  command.add_flag("--json", options->print_json, "Print as JSON");
  add_threads_option(command, options->threads);
  command.callback([command, options] {
    const bool draws = !options->components.empty() || !options->component_spheres.empty();
    if (!draws && command.count("--count") + command.count("--size") > 0)
      gonio::refuse("--count and --size need --components or --component-spheres");
    const json facts = describe_file(*options);
    if (options->print_json)
      std::cout << facts.dump(2) << '\n';
    else
      print(facts);
  });
}

}  // namespace cli
