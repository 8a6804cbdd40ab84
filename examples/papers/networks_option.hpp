#pragma once
/// Options for the materials of an experiment and the number of measurements.

#include "papers/experiments.hpp"
#include "tool/options/thinning.hpp"
#include <gonio/io/materials/networks.hpp>

#include <filesystem>
#include <vector>

namespace papers {

inline void add_networks_option(command& to, std::filesystem::path& networks) {
  to.add_input("--networks", networks, "File of networks of the 100 materials (.npy)").required();
}

/// A file of networks, and the cells of MERL's grid on which its materials are tabulated.
struct studied_networks {
  std::filesystem::path file;
  thinning thin = {};

  [[nodiscard]] gonio::model::named_networks read() const { return gonio::io::read_networks(file); }
  [[nodiscard]] gonio::valid_cells cells() const { return thin.of(gonio::valid_cells()); }
};

inline void add_networks_option(command& to, studied_networks& networks) {
  add_networks_option(to, networks.file);
  add_thin_option(to, networks.thin);
}

inline void add_counts_option(command& to, std::vector<Eigen::Index>& counts) {
  to.add_option("-n,--counts", counts, "Numbers of measurements").check(check::positive_number()).capture_default_str();
}

}  // namespace papers
