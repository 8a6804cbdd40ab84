#pragma once
/// Maps of a synthetic sample beside the truth: the material of each texel, and an image of all maps.

#include "papers/our_own/synthetic_texels.hpp"
#include <gonio/basis/pca.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/io/materials/svbrdf_map.hpp>
#include <gonio/model/adaptive_brdf.hpp>
#include <gonio/table/image.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace papers {

class svbrdf_maps {
 public:
  /// All arguments must outlive this object. `labels` is the .npy file of `gonio texels --clusters`, with one cluster
  /// per material.
  svbrdf_maps(const gonio::log_relative_pca& prior, const gonio::io::svbrdf_map& map, const synthetic_texels& texels,
              const std::vector<gonio::model::adaptive_brdf>& materials, const std::filesystem::path& labels);

  /// Prints the share of texels whose label is their main material, also for k-means with other distances.
  void print_labels(gonio::thread_count threads) const;

  /// Returns an image of truth, estimate and their Delta E; below them the main material of each texel, disagreement
  /// and clusters. Each map has `size` x `size` texels of a grid. Prints the mean Delta E.
  [[nodiscard]] gonio::image figure(Eigen::Index size) const;

 private:
  [[nodiscard]] Eigen::Index main_material(Eigen::Index row, Eigen::Index column) const;
  [[nodiscard]] std::uint8_t label(Eigen::Index row, Eigen::Index column) const {
    return labels_[static_cast<std::size_t>(row * map_.header().columns + column)];
  }

  const gonio::log_relative_pca& prior_;
  const gonio::io::svbrdf_map& map_;
  const synthetic_texels& texels_;
  const std::vector<gonio::model::adaptive_brdf>& materials_;
  std::vector<std::uint8_t> labels_;
};

}  // namespace papers
