#pragma once
/// Maps of a synthetic sample beside the truth: which texels are of one material, and an image of it all.

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
  /// All must outlive it. `labels` is what `gonio texels --clusters` wrote (.npy), as many clusters as materials.
  svbrdf_maps(const gonio::log_relative_pca& prior, const gonio::io::svbrdf_map& map, const synthetic_texels& texels,
              const std::vector<gonio::model::adaptive_brdf>& materials, const std::filesystem::path& labels);

  /// The share of texels that are labelled by the material that they have most of; and by k-means of other distances.
  void print_labels(gonio::thread_count threads) const;

  /// Truth, estimate and their Delta E, below them the material that a texel has most of, disagreement and the
  /// clusters, each of `size` x `size` texels of a grid. Prints the mean Delta E.
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
