#pragma once
/// The materials of the benchmarks: the surrogates of the MERL materials at full resolution if the networks are
/// available, otherwise the shipped prior's approximations on its own cells.

#include <gonio/basis/expand_materials.hpp>
#include <gonio/io/materials/networks.hpp>
#include <gonio/io/materials/prior.hpp>

#include <filesystem>
#include <utility>

inline gonio::material_set real_materials() {
  const std::filesystem::path networks = GONIO_BENCH_NETWORKS;
  if (std::filesystem::exists(networks))
    return gonio::model::tabulate_networks(gonio::io::read_networks(networks), gonio::valid_cells());
  return gonio::expand(gonio::io::read_prior(GONIO_SOURCE_PRIOR));
}
