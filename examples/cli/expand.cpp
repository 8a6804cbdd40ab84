/// gonio expand: a material as a table, from a network or a formula.

#include "command.hpp"
#include "inputs.hpp"
#include <gonio/io/merl.hpp>
#include <gonio/model/formula_materials.hpp>

#include <memory>

namespace cli {

namespace {

struct expand_options {
  std::filesystem::path networks, output;
  std::string name, formula;
  gonio::thread_count threads;
};

gonio::brdf_table table_of(const expand_options& options, const gonio::valid_cells& cells) {
  if (!options.formula.empty())
    return gonio::tabulate(gonio::formula_material(options.formula), cells, options.threads);
  const auto chosen = networks_in(gonio::io::read_networks(options.networks), {options.name});
  return gonio::tabulate_networks(chosen, cells, options.threads).table(0);
}

}  // namespace

void add_expand(CLI::App& app) {
  auto* command = app.add_subcommand("expand", "Write a material given by a network or a formula as a MERL table");
  const auto options = std::make_shared<expand_options>();
  auto* networks = command->add_option("--networks", options->networks,
                                       "File of networks (.npy, names in merl_names.txt beside it)");
  auto* name =
      command->add_option("--name", options->name, "Name of the material in the networks' list")->needs(networks);
  networks->needs(name);
  std::string known;
  for (const std::string& formula : gonio::formula_material_names()) known += (known.empty() ? "" : ", ") + formula;
  command->add_option("--formula", options->formula, "Name of a material given by a formula: " + known)
      ->excludes(networks);
  command->add_option("-o,--output", options->output, "Table to write (.binary)")->required();
  add_threads_option(*command, options->threads);
  command->callback([options] {
    if (options->formula.empty() && options->name.empty())
      throw gonio::error("expand needs a material: --networks FILE --name NAME, or --formula NAME");
    gonio::io::write_merl(options->output, table_of(*options, gonio::valid_cells()));
  });
}

}  // namespace cli
