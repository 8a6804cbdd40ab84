/// gonio expand: a material as a table, from a network, the prior or a formula.

#include "command_line/chosen_networks.hpp"
#include "command_line/measurement_files.hpp"
#include "command_line/prior_option.hpp"
#include "command_line/threads_option.hpp"
#include "commands.hpp"
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/io/merl.hpp>
#include <gonio/io/networks.hpp>
#include <gonio/io/prior.hpp>
#include <gonio/model/formula_materials.hpp>

#include <algorithm>
#include <memory>

namespace cli {

namespace {

struct expand_options {
  std::filesystem::path networks, prior, output;
  std::string name, formula;
  gonio::thread_count threads;
};

/// One of the materials a prior was learned from, by the coefficients that it stores.
gonio::brdf_table table_of_prior(const expand_options& options, const gonio::valid_cells& cells) {
  const auto prior = gonio::io::read_prior(options.prior);
  const auto found = std::ranges::find(prior.names(), options.name);
  if (found == prior.names().end())
    gonio::refuse(options.prior.string() + ": there is no material named '" + options.name + "'");
  gonio::solution stored;
  stored.weights = prior.weights_of(found - prior.names().begin());
  return gonio::fitted_brdf(prior, std::move(stored)).tabulate(cells, options.threads);
}

gonio::brdf_table table_of(const expand_options& options, const gonio::valid_cells& cells) {
  if (!options.formula.empty())
    return gonio::tabulate(gonio::model::formula_material(options.formula), cells, options.threads);
  if (options.networks.empty()) return table_of_prior(options, cells);
  const auto chosen = networks_in(gonio::io::read_networks(options.networks), {options.name});
  return gonio::model::tabulate_networks(chosen, cells, options.threads).table(0);
}

}  // namespace

void add_expand(command& app) {
  auto command =
      app.add_subcommand("expand", "Write a material given by a network, the prior or a formula as a MERL table");
  const auto options = std::make_shared<expand_options>();
  auto networks =
      command.add_input("--networks", options->networks, "File of networks (.npy, names in merl_names.txt beside it)");
  add_prior_option(command, options->prior);
  command.add_option("--name", options->name, "Name of a material of the networks, or else of the prior");
  std::string known;
  for (const std::string& formula : gonio::model::formula_material_names())
    known += (known.empty() ? "" : ", ") + formula;
  command.add_option("--formula", options->formula, "Name of a material given by a formula: " + known)
      .excludes(networks);
  command.add_output("-o,--output", options->output, {".binary", ".npy"}, "Table to write (.binary, or .npy)")
      .required();
  add_threads_option(command, options->threads);
  command.callback([options] {
    if (options->formula.empty() && options->name.empty())
      gonio::refuse("expand needs a material: --name NAME (of --prior or --networks), or --formula NAME");
    write_table(options->output, table_of(*options, gonio::valid_cells()));
  });
}

}  // namespace cli
