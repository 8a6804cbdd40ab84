/// gonio info: what a file holds.

#include "command_line/json.hpp"
#include "command_line/measurement_files.hpp"
#include "command_line/measures_as_json.hpp"
#include "commands.hpp"
#include <gonio/basis/pca.hpp>
#include <gonio/core/printable.hpp>
#include <gonio/io/merl_gzip.hpp>
#include <gonio/io/networks.hpp>
#include <gonio/io/prior.hpp>
#include <gonio/model/measured_properties.hpp>

#include <iostream>
#include <memory>

namespace cli {

namespace {

struct info_options {
  std::filesystem::path file;
  bool print_json = false;
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

json describe(const gonio::sample_set& samples) {
  gonio::rgb low = samples.front().value, high = low;
  for (const gonio::sample& s : samples) {
    low = low.min(s.value);
    high = high.max(s.value);
  }
  return {
      {"kind", "samples"}, {"samples", samples.size()}, {"minimum", per_channel(low)}, {"maximum", per_channel(high)}};
}

/// By what the file starts with or how its name ends.
json describe_file(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  if (name.ends_with(".csv") || name.ends_with(".brdf")) return describe(read_measurements(path));
  if (name.ends_with(".npy")) {
    const auto networks = gonio::io::read_networks(path);
    return {{"kind", "networks"}, {"materials", networks.names.size()}, {"names", networks.names}};
  }
  if (gonio::io::is_prior(path)) return describe(gonio::io::read_prior(path));
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
  command.add_flag("--json", options->print_json, "Print as JSON");
  command.callback([options] {
    const json facts = describe_file(options->file);
    if (options->print_json)
      std::cout << facts.dump(2) << '\n';
    else
      print(facts);
  });
}

}  // namespace cli
