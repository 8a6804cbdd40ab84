#include "materials.hpp"

#include "chosen_networks.hpp"
#include <gonio/basis/expand_materials.hpp>
#include <gonio/io/merl_directory.hpp>
#include <gonio/io/prior.hpp>

namespace cli {

option_group add_material_options(command& to, material_source& source) {
  option_group group = to.add_option_group("source", "Where the materials come from (one of)");
  group.add_input("--networks", source.networks, "File of networks (.npy, names in merl_names.txt beside it)");
  group.add_input_folder("--merl", source.tables, {".binary", ".gz"}, "Folder of MERL tables (.binary or .binary.gz)");
  group.require_option(0, 1);
  to.add_option("--exclude", source.exclude, "Name of a material to leave out (repeatable)").repeatable();
  return group;
}

gonio::material_set read_materials(const material_source& source, gonio::thread_count threads,
                                   const gonio::progress& listener) {
  if (!source.tables.empty()) return gonio::io::read_merl_directory(source.tables, source.exclude, listener);
  if (source.networks.empty()) return gonio::expand(gonio::io::read_prior(source.prior), threads);
  const auto chosen = networks_except(gonio::io::read_networks(source.networks), source.exclude);
  return gonio::model::tabulate_networks(chosen, gonio::valid_cells(), threads, listener);
}

}  // namespace cli
