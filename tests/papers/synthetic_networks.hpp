#pragma once
/// Networks of random weights, as the experiments read them.

#include "../io/scratch.hpp"
#include <gonio/io/bytes/npy.hpp>

#include <random>
#include <string>
#include <vector>

/// Writes n.npy and merl_names.txt with a network of each name to a folder. None is black.
inline void write_synthetic_networks(const scratch::folder& folder, const std::vector<std::string>& names) {
  xt::xtensor<float, 2> weights(std::array<std::size_t, 2>{names.size(), 675});
  std::mt19937 generator(7);
  std::normal_distribution<float> normal(0.0f, 0.3f);
  for (float& weight : weights) weight = normal(generator);
  std::string lines;
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (std::size_t c = 672; c < 675; ++c) weights(i, c) = 0.2f;
    lines += names[i] + '\n';
  }
  gonio::io::write_npy(folder / "n.npy", weights);
  scratch::put(folder / "merl_names.txt", lines);
}
