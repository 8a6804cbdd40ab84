#pragma once
/// Measured materials, each reconstructed by a prior that was learned without its family: the protocol of
/// docs/results/real-materials.md and real-methods.md.

#include "papers/resumable_results.hpp"
#include "tool/files/json.hpp"
#include "tool/options/command.hpp"
#include "tool/options/thinning.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/basis/pca.hpp>
#include <gonio/core/progress.hpp>
#include <gonio/evaluate/comparison.hpp>
#include <gonio/table/brdf_table.hpp>
#include <gonio/table/material_set.hpp>
#include <gonio/table/sample_set.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace papers {

/// Tables of materials to reconstruct or to learn from.
class material_library {
 public:
  /// Reads files of networks (.npy) and a folder of measured materials (.bsdf). Throws gonio::error if the folder has
  /// no material.
  material_library(const std::vector<std::filesystem::path>& networks, const std::filesystem::path& measured,
                   const cli::thinning& thin, const gonio::progress& listener, gonio::thread_count threads);

  [[nodiscard]] const gonio::valid_cells& cells() const noexcept { return cells_; }
  [[nodiscard]] const gonio::material_set& measured() const noexcept { return sets_.back(); }
  [[nodiscard]] const gonio::material_set& first() const noexcept { return sets_.front(); }

  /// Returns those materials of the first `sets` sets for which `keep` is true. The last set holds the measured
  /// materials.
  template <class Keep>
  [[nodiscard]] gonio::material_set materials(Eigen::Index sets, const Keep& keep) const {
    gonio::material_set chosen{cells_, {}, {}};
    Eigen::Index columns = 0;
    for (Eigen::Index s = 0; s < sets; ++s) columns += 3 * std::ranges::count_if(sets_[s].names, keep);
    chosen.values.resize(static_cast<Eigen::Index>(cells_.size()), columns);
    for (Eigen::Index s = 0; s < sets; ++s)
      for (Eigen::Index i = 0; i < std::ssize(sets_[s].names); ++i) {
        if (!keep(sets_[s].names[i])) continue;
        chosen.values.middleCols(3 * std::ssize(chosen.names), 3) =
            sets_[s].values.middleCols(3 * static_cast<Eigen::Index>(i), 3);
        chosen.names.push_back(sets_[s].names[i]);
      }
    return chosen;
  }
  [[nodiscard]] Eigen::Index all() const noexcept { return std::ssize(sets_); }

  /// Returns the principal components of all materials outside a family, and of some random_material's, under
  /// log_relative to the median of all.
  [[nodiscard]] gonio::log_relative_pca prior_without(const std::string& family, Eigen::Index components,
                                                      Eigen::Index random_materials = 0) const;

 private:
  gonio::valid_cells cells_;
  gonio::thread_count threads_;
  std::vector<gonio::material_set> sets_;
};

/// Options of the experiments that leave out each material's family.
struct left_out_options : resumable_options {
  std::vector<std::filesystem::path> networks;
  std::filesystem::path materials;
  Eigen::Index components = 100;
  cli::thinning thin{{3, 5}};
};

/// Adds `--networks`, `--materials`, `--components`, `--thin`, `--state` and `--threads`.
void add_left_out_options(cli::command& to, left_out_options& options);

/// Reflectance in a pair of directions, sr^-1.
using reflectance = std::function<gonio::rgb(const gonio::direction_pair&)>;

/// A material to reconstruct, and the family to leave out of its prior.
struct judged_material {
  std::string name, family;
  gonio::brdf_table truth;
  reflectance measured;
  std::uint64_t number = 0;  ///< position in the list; seeds the noise and the outliers
  std::size_t turn = 0;      ///< turn of the family: one process reconstructs the whole family by one prior
};

/// Returns the measured materials. The library must have been made from the same folder.
[[nodiscard]] std::vector<judged_material> measured_materials(const std::filesystem::path& folder,
                                                              const material_library& library);

/// Base of the experiments that leave out each material's family: materials, errors, and results that survive an
/// interruption.
class left_out_experiment {
 protected:
  left_out_experiment(const left_out_options& given, cli::progress_bar& bar);

  [[nodiscard]] gonio::comparison compare(const gonio::brdf_table& table, const judged_material& material) const {
    return gonio::compare(table, material.truth, metric_, judge_, threads_);
  }

  /// Returns the result of `work` through resumable_results. The progress bar displays `shown`.
  template <class Work>
  [[nodiscard]] const cli::json& once(const cli::json& key, std::size_t turn, const std::string& shown, Work&& work) {
    return results_.once(key, turn, [&] {
      bar_.draw(shown, 0.0);
      return work();
    });
  }

  cli::progress_bar& bar_;
  gonio::thread_count threads_;
  material_library library_;
  gonio::appearance_metric judge_;
  gonio::log_relative metric_;

 private:
  resumable_results results_;
};

/// Sets of directions under one name, one for each repetition.
struct sampling {
  std::string name;
  std::vector<std::vector<gonio::half_difference>> sets;
  double judged_from = 0.0;  ///< smallest theta_h, in radians, at which coverage is counted
};

/// "20 random": random cells of MERL's grid, drawn anew for each repetition.
[[nodiscard]] sampling random_sampling(Eigen::Index count, Eigen::Index repetitions);

/// Returns the values in some directions, with noise relative to each channel.
[[nodiscard]] gonio::sample_set measure(const reflectance& of, const std::vector<gonio::half_difference>& directions,
                                        double noise, std::uint64_t seed);

/// Returns the values of a prior's mean material in the samples' directions.
[[nodiscard]] gonio::sample_set of_mean_material(const gonio::sample_set& samples,
                                                 const gonio::log_relative_pca& prior);

}  // namespace papers
