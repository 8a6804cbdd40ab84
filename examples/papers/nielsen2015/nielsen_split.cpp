#include "papers/nielsen2015/nielsen_split.hpp"

#include "papers/networks_option.hpp"
#include "tool/options/chosen_networks.hpp"
#include "tool/options/shipped_data.hpp"
#include <gonio/basis/pca.hpp>
#include <gonio/evaluate/test_materials.hpp>
#include <gonio/io/materials/networks.hpp>
#include <gonio/io/measurements/samples.hpp>

#include <utility>

namespace papers {

gonio::log_relative_pca learn_all_components(const gonio::model::named_networks& networks,
                                             const gonio::valid_cells& cells, gonio::thread_count threads,
                                             const gonio::progress& listener, gonio::cosine_weighting weighting) {
  constexpr std::size_t every_component = 300;
  auto materials = gonio::model::tabulate_networks(networks, cells, threads, listener);
  const auto metric = gonio::log_relative::to_median_of(materials, threads).weighted_by(weighting);
  return gonio::learn_pca(std::move(materials), metric, every_component, threads, listener);
}

nielsen_split nielsen_split::learn(const studied_networks& networks, gonio::thread_count threads,
                                   const gonio::progress& listener, gonio::cosine_weighting weighting) {
  const auto all = networks.read();
  const auto& tested = gonio::nielsen_test_materials();
  const auto cells = networks.cells();
  return {learn_all_components(networks_except(all, tested, networks.file), cells, threads, listener, weighting),
          gonio::model::tabulate_networks(networks_in(all, tested, networks.file), cells, threads)};
}

std::filesystem::path shipped_directions() { return shipped_file("directions"); }

std::string points_file(const std::string& set, std::size_t count) {
  return "point-" + std::to_string(count) + '-' + set + ".csv";
}

std::optional<std::vector<gonio::half_difference>> written_points(const std::filesystem::path& folder,
                                                                  const std::string& set, std::size_t count) {
  if (set == "published") {
    if (!gonio::design::has_nielsen_directions(count)) return {};
    return gonio::design::nielsen_directions(count);
  }
  const auto file = folder / points_file(set, count);
  if (!std::filesystem::exists(file)) return {};
  std::vector<gonio::half_difference> directions;
  for (const auto& [wi, wo] : gonio::io::read_direction_pairs(file))
    directions.push_back(gonio::to_half_difference(wi, wo));
  return directions;
}

std::vector<gonio::half_difference> required_points(const std::filesystem::path& folder, const std::string& set,
                                                    std::size_t count) {
  if (auto found = written_points(folder, set, count)) return std::move(*found);
  gonio::refuse("there is no set '" + set + "' of " + std::to_string(count) + " directions, no " +
                (folder / points_file(set, count)).string());
}

}  // namespace papers
