#pragma once
/// The experiment of Nielsen et al. 2015, section 6, that most tables are of: 90 materials learned, ten others tested.

#include "papers/experiments.hpp"
#include "papers/material_result.hpp"
#include "papers/networks_option.hpp"
#include <gonio/basis/learn_pca.hpp>
#include <gonio/basis/pca.hpp>
#include <gonio/design/published_directions.hpp>
#include <gonio/io/materials/networks.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace papers {

/// All principal components of some networks' materials, relative to their median.
[[nodiscard]] gonio::log_relative_pca learn_all_components(
    const gonio::model::named_networks& networks, const gonio::valid_cells& cells, gonio::thread_count threads,
    const gonio::progress& listener, gonio::cosine_weighting weighting = gonio::cosine_weighting::product);

/// What is learned from, and what is tested.
struct nielsen_split {
  gonio::log_relative_pca prior;  ///< of the 90, with all components
  gonio::material_set truths;     ///< the ten

  /// From a file of the 100 networks.
  static nielsen_split learn(const studied_networks& networks, gonio::thread_count threads,
                             const gonio::progress& listener);
};

/// Folder of the sets of directions that ship with the tool.
[[nodiscard]] std::filesystem::path shipped_directions();

/// What the file of such a set is called.
[[nodiscard]] std::string points_file(const std::string& set, std::size_t count);

/// A set of points that is written down: `published`, or one of a folder, named after its number and criterion as
/// `gonio-papers directions --write` does. Nothing where there is none of that many.
[[nodiscard]] std::optional<std::vector<gonio::half_difference>> written_points(const std::filesystem::path& folder,
                                                                                const std::string& set,
                                                                                std::size_t count);

}  // namespace papers
