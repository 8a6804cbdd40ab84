/// gonio-papers implausible-samples: how often values that are no BRDF are noticed, and how often a true BRDF is
/// doubted.

#include "papers/experiments.hpp"
#include "papers/networks_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/sample_warnings.hpp"
#include <gonio/core/random.hpp>
#include <gonio/io/materials/rgl.hpp>
#include <gonio/io/measurements/samples.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace papers {

namespace {

using gonio::io::sample_quantity;

struct implausible_options {
  std::filesystem::path networks, rgl;
  std::uint64_t seed = 1;
};

struct direction_set {
  std::string name;
  std::vector<gonio::direction_pair> pairs;
};

direction_set in_plane_scan(double theta_i) {
  direction_set set{"in-plane scan, light at " + fixed(theta_i, 0) + " degrees", {}};
  for (int theta_o = -80; theta_o <= 80; theta_o += 4)
    set.pairs.push_back({gonio::spherical_direction(gonio::radians(theta_i), 0.0),
                         gonio::spherical_direction(gonio::radians(theta_o), 0.0)});
  return set;
}

direction_set random_directions(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  const auto direction = [&] {
    const double theta = gonio::radians(85.0) * gonio::uniform_number(generator);
    return gonio::spherical_direction(theta, 2.0 * std::numbers::pi * gonio::uniform_number(generator));
  };
  direction_set set{"random, uniform in the angles", {}};
  for (std::size_t i = 0; i < count; ++i) {
    const gonio::direction wi = direction();
    set.pairs.push_back({wi, direction()});
  }
  return set;
}

/// The number of materials and, by quantity, how often that quantity is named correctly or mistaken for another one.
struct tally {
  int materials = 0;
  std::array<int, gonio::io::sample_quantity_names.size()> named{}, mistaken{};
};

/// Counts the doubts about a material's samples in each quantity, given as if they were BRDF values.
template <gonio::brdf Brdf>
void count(const Brdf& material, const direction_set& set, tally& sum) {
  ++sum.materials;
  for (std::size_t q = 0; q < sum.named.size(); ++q) {
    const auto quantity = static_cast<sample_quantity>(q);
    gonio::io::sample_file file;
    for (const auto& pair : set.pairs)
      file.samples.push_back({pair, material(pair.wi, pair.wo) / brdf_factor(quantity, pair.wo), 1.0});
    bool is_named = false, is_mistaken = false;
    for (const std::string& sentence : doubts_of(file)) {
      const bool is_right = sentence.find("--quantity " + std::string(name_of(quantity)) + ")") != std::string::npos;
      (is_right ? is_named : is_mistaken) = true;
    }
    sum.named[q] += is_named ? 1 : 0;
    sum.mistaken[q] += is_mistaken ? 1 : 0;
  }
}

void print(const std::string& materials, const direction_set& set, const tally& sum) {
  std::cout << "| " << materials << " | " << set.name << " | " << set.pairs.size() << " | " << sum.mistaken[0] << " of "
            << sum.materials;
  for (std::size_t q = 1; q < sum.named.size(); ++q) std::cout << " | " << sum.named[q] << ", " << sum.mistaken[q];
  std::cout << " |\n";
}

void run(const implausible_options& given) {
  const gonio::model::named_networks networks = gonio::io::read_networks(given.networks);
  std::vector<gonio::model::adaptive_brdf> measured;
  for (const auto& [name, path] : gonio::io::list_rgl_directory(given.rgl))
    measured.push_back(gonio::io::read_rgl(path).material);
  std::cout << "| materials | directions | samples | a BRDF is doubted | BRDF times cosine: noticed, mistaken | "
               "reflectance factors | percent |\n|---|---|---|---|---|---|---|\n";
  for (const direction_set& set : {in_plane_scan(0.0), in_plane_scan(45.0), random_directions(20, given.seed),
                                   random_directions(200, given.seed)}) {
    tally of_networks, of_measured;
    for (const auto& network : networks.networks) count(network, set, of_networks);
    for (const gonio::model::adaptive_brdf& material : measured) count(material, set, of_measured);
    print("networks", set, of_networks);
    print("measured", set, of_measured);
  }
}

}  // namespace

void add_implausible_samples(command& app) {
  auto command = app.add_subcommand("implausible-samples",
                                    "How often numbers that are no BRDF are noticed, and how often a BRDF is doubted");
  const auto options = std::make_shared<implausible_options>();
  add_networks_option(command, options->networks);
  command.add_input_folder("--rgl", options->rgl, {".bsdf"}, "Folder of measured materials (.bsdf)").required();
  command.add_option("--seed", options->seed, "Seed of the random directions").capture_default_str();
  command.callback([options] { run(*options); });
}

}  // namespace papers
