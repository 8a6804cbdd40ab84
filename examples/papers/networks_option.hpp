#pragma once
/// Which materials an experiment studies, and from how many measurements.

#include "papers/experiments.hpp"
#include "tool/options/thinning.hpp"
#include <gonio/io/materials/networks.hpp>

#include <filesystem>
#include <vector>

namespace papers {

/// Adds `--networks FILE`, which must be given.
inline void add_networks_option(command& to, std::filesystem::path& networks) {
  to.add_input("--networks", networks, "File of networks of the 100 materials (.npy)").required();
}

/// A file of networks, and the cells of MERL's grid that its materials are tabulated over.
struct studied_networks {
  std::filesystem::path file;
  thinning thin = {};

  [[nodiscard]] gonio::model::named_networks read() const { return gonio::io::read_networks(file); }
  [[nodiscard]] gonio::valid_cells cells() const { return thin.of(gonio::valid_cells()); }
};

/// Adds `--networks FILE`, which must be given, and `--thin N M`.
inline void add_networks_option(command& to, studied_networks& networks) {
  add_networks_option(to, networks.file);
  add_thin_option(to, networks.thin);
}

/// Adds `-n,--counts N ...`.
inline void add_counts_option(command& to, std::vector<Eigen::Index>& counts) {
  to.add_option("-n,--counts", counts, "Numbers of measurements").check(check::positive_number()).capture_default_str();
}

}  // namespace papers
