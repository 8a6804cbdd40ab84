#pragma once
/// The split that most tables of Nielsen et al. 2015 use (section 6): 90 materials learned, ten others tested.

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

/// Learns all principal components of the materials of some networks, relative to their median.
[[nodiscard]] gonio::log_relative_pca learn_all_components(
    const gonio::model::named_networks& networks, const gonio::valid_cells& cells, gonio::thread_count threads,
    const gonio::progress& listener, gonio::cosine_weighting weighting = gonio::cosine_weighting::product);

/// The learned prior and the materials to test.
struct nielsen_split {
  gonio::log_relative_pca prior;  ///< the prior of the 90 learned materials, with all components
  gonio::material_set truths;     ///< the ten

  /// Learns from a file of the 100 networks.
  static nielsen_split learn(const studied_networks& networks, gonio::thread_count threads,
                             const gonio::progress& listener,
                             gonio::cosine_weighting weighting = gonio::cosine_weighting::product);
};

/// Returns the folder of the sets of directions that ship with the tool.
[[nodiscard]] std::filesystem::path shipped_directions();

/// Returns the file name of a set of points.
[[nodiscard]] std::string points_file(const std::string& set, std::size_t count);

/// Reads a set of `count` points: the published one if `set` is `published`, otherwise the file that `gonio-papers
/// directions --write` writes to the folder. Returns nothing if there is no such set.
[[nodiscard]] std::optional<std::vector<gonio::half_difference>> written_points(const std::filesystem::path& folder,
                                                                                const std::string& set,
                                                                                std::size_t count);

/// Returns `written_points`. Throws gonio::error that names the file if there is no such set.
[[nodiscard]] std::vector<gonio::half_difference> required_points(const std::filesystem::path& folder,
                                                                  const std::string& set, std::size_t count);

}  // namespace papers
