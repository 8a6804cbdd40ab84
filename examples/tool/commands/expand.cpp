/// gonio expand: a material as a table, from a network, the prior or a formula.

#include "commands.hpp"
#include "tool/files/file_kinds.hpp"
#include "tool/files/file_start.hpp"
#include "tool/files/measurement_files.hpp"
#include "tool/options/albedo_tolerance_option.hpp"
#include "tool/options/chosen_networks.hpp"
#include "tool/options/number_list.hpp"
#include "tool/options/prior_material.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/options/threads_option.hpp"
#include <gonio/basis/component_variance.hpp>
#include <gonio/core/finite.hpp>
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/io/materials/merl.hpp>
#include <gonio/io/materials/networks.hpp>
#include <gonio/model/formula_materials.hpp>

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace cli {

namespace {

struct expand_options {
  std::filesystem::path networks, prior, output;
  std::string name, formula;
  std::vector<std::string> weights;  ///< lists of numbers: one for all channels (or wavelengths), or one per channel
  bool in_deviations = false;
  writing how;
};

/// Returns the weights from --weights, components x channels; zeros where none is given.
Eigen::MatrixXd given_weights(const expand_options& options, const gonio::log_relative_pca& prior) {
  const Eigen::Index channels = prior.channels(), lists = std::ssize(options.weights);
  if (lists != 1 && lists != channels && prior.wavelengths().empty())
    gonio::refuse({"--weights needs one list for all channels, or three for red, green and blue, not ", lists});
  if (lists != 1 && lists != channels)
    gonio::refuse(
        {"--weights needs one list for all wavelengths, or one for each of ", channels, " wavelengths, not ", lists});
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(prior.size(), channels);
  for (Eigen::Index channel = 0; channel < channels; ++channel) {
    const auto numbers = numbers_in(options.weights[options.weights.size() == 1 ? 0 : channel], "--weights");
    if (std::ssize(numbers) > prior.size())
      gonio::refuse({"--weights: ", numbers.size(), " numbers, but there are only ", prior.size(), " components of ",
                     options.prior.native()});
    for (Eigen::Index j = 0; j < std::ssize(numbers); ++j) weights(j, channel) = numbers[j];
  }
  if (options.in_deviations) weights.array().colwise() *= gonio::weight_deviations(prior.coefficients()).array();
  return weights;
}

void require_finite(const expand_options& options, std::span<const float> values) {
  if (!options.weights.empty() && !gonio::all_finite(values))
    gonio::refuse("--weights are too large: their table is not finite (gonio info --components has the deviations)");
}

/// Writes spectra if the format holds them, else their colours.
void write_spectra(const expand_options& options, const gonio::spectral_table& table) {
  if (lower_extension(options.output) != ".bsdf" || table.bands() == 1)
    return write_file(options.output, table.colours(gonio::illuminant::d65, options.how.threads), options.how);
  write_spectra(options.output, table, options.name.empty() ? options.output.stem().string() : options.name,
                options.how);
}

/// Writes a material of the prior, or without --name its mean material, with --weights added.
void write_of_prior(const expand_options& options, const gonio::valid_cells& cells) {
  const auto prior = read_prior(options.prior);
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(prior.size(), prior.channels());
  if (!options.name.empty()) weights = prior.weights_of(material_number(prior, options.name, options.prior));
  if (!options.weights.empty()) weights += given_weights(options, prior);
  if (prior.wavelengths().empty()) {
    const gonio::brdf_table table = gonio::fitted_brdf(prior, std::move(weights)).tabulate(cells, options.how.threads);
    require_finite(options, table.values());
    return write_file(options.output, table, options.how);
  }
  const gonio::fitted_brdf fitted(prior, std::move(weights), {}, gonio::channels(prior.wavelengths()));
  const gonio::spectral_table table = fitted.tabulate_spectra(cells, options.how.threads);
  require_finite(options, {table.values().data(), static_cast<std::size_t>(table.values().size())});
  write_spectra(options, table);
}

void expand(const expand_options& options, const gonio::valid_cells& cells) {
  if (!options.formula.empty())
    return write_file(options.output,
                      gonio::tabulate(gonio::model::formula_material(options.formula), cells, options.how.threads),
                      options.how);
  if (options.networks.empty()) return write_of_prior(options, cells);
  const auto chosen = networks_in(gonio::io::read_networks(options.networks), {options.name}, options.networks);
  write_file(options.output, gonio::model::tabulate_networks(chosen, cells, options.how.threads).table(0), options.how);
}

}  // namespace

void add_expand(command& app) {
  auto command =
      app.add_subcommand("expand", "Write a material as a table: from a network, the prior, weights or a formula");
  const auto options = std::make_shared<expand_options>();
  auto networks =
      command.add_input("--networks", options->networks, "File of networks (.npy, names in merl_names.txt beside it)");
  add_prior_option(command, options->prior);
  command.add_option("--name", options->name, "Name of a material in --networks or, without --networks, in the prior");
  auto weights = command
                     .add_option("--weights", options->weights,
                                 "Weights of the prior's components, as 0.5,-1,2; omitted ones are 0. Give one list "
                                 "for all channels, or one for each of red, green and blue (or each wavelength of a "
                                 "spectral prior). With --name: added to that material's weights")
                     .repeatable()
                     .excludes(networks);
  command
      .add_flag("--in-deviations", options->in_deviations,
                "Give --weights in standard deviations of the weights of the prior's materials")
      .needs(weights);
  std::string known;
  for (const std::string& formula : gonio::model::formula_material_names())
    known += (known.empty() ? "" : ", ") + formula;
  command.add_option("--formula", options->formula, "Name of a material given by a formula: " + known)
      .excludes(networks)
      .excludes(weights);
  command
      .add_output("-o,--output", options->output, {".binary", ".npy", ".bsdf", ".mbsdf"},
                  "Table to write (.binary, .npy, or .bsdf or .mbsdf for renderers)")
      .required();
  add_albedo_tolerance_option(command, options->how.albedo_tolerance);
  add_threads_option(command, options->how.threads);
  command.callback([options] {
    if (options->formula.empty() && options->name.empty() && options->weights.empty())
      gonio::refuse(
          "expand needs a material: --name NAME (of --prior or --networks), --weights W1,W2,... or --formula NAME");
    require_bsdf(options->how.albedo_tolerance, options->output);
    expand(*options, gonio::valid_cells());
  });
}

}  // namespace cli
