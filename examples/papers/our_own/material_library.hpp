#pragma once
/// Materials that are judged, or learned from, as tables: networks, and measured materials of the RGL database.

#include "papers/experiments.hpp"
#include <gonio/basis/pca.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/core/progress.hpp>
#include <gonio/table/material_set.hpp>
#include <gonio/table/sample_set.hpp>
#include <gonio/table/valid_cells.hpp>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace papers {

/// Materials of one maker: names before the first underscore are alike.
[[nodiscard]] std::string family_of(const std::string& name);

/// A material that is judged: its table, and its values in any directions.
struct real_material {
  std::string name, family;
  gonio::brdf_table truth;
  std::function<gonio::rgb(const gonio::direction_pair&)> measured;
};

/// Measured in some directions, without noise.
[[nodiscard]] gonio::sample_set samples_of(const real_material& material,
                                           const std::vector<gonio::half_difference>& directions);

/// The same directions as those of some samples, as if a prior's mean material lay there.
[[nodiscard]] gonio::sample_set of_mean_material(const gonio::sample_set& samples,
                                                 const gonio::log_relative_pca& prior);

class material_library {
 public:
  /// Reads files of networks and a folder of measured materials (.bsdf). Throws gonio::error if the folder has none.
  material_library(const std::vector<std::filesystem::path>& networks, const std::filesystem::path& materials,
                   gonio::valid_cells cells, gonio::thread_count threads, const gonio::progress& listener);

  [[nodiscard]] const gonio::valid_cells& cells() const noexcept { return cells_; }
  [[nodiscard]] const gonio::material_set& measured() const noexcept { return sets_.back(); }
  [[nodiscard]] const gonio::material_set& first() const noexcept { return sets_.front(); }
  [[nodiscard]] Eigen::Index all() const noexcept { return std::ssize(sets_); }

  /// Of the first `sets` files of networks, or of everything, the materials that `keep` does not refuse.
  template <class Keep>
  [[nodiscard]] gonio::material_set materials(Eigen::Index sets, const Keep& keep) const {
    gonio::material_set chosen{cells_, {}, {}};
    Eigen::Index columns = 0;
    for (Eigen::Index s = 0; s < sets; ++s) columns += 3 * std::ranges::count_if(sets_[s].names, keep);
    chosen.values.resize(cells_.size(), columns);
    for (Eigen::Index s = 0; s < sets; ++s)
      for (Eigen::Index i = 0; i < std::ssize(sets_[s].names); ++i) {
        if (!keep(sets_[s].names[i])) continue;
        chosen.values.middleCols(3 * std::ssize(chosen.names), 3) = sets_[s].values.middleCols(3 * i, 3);
        chosen.names.push_back(sets_[s].names[i]);
      }
    return chosen;
  }

  /// The measured materials, in the order of their names.
  [[nodiscard]] std::vector<real_material> real_materials() const;

  /// Components of everything but a family, under log_relative of the median of what is left.
  [[nodiscard]] gonio::log_relative_pca prior_without(const std::string& family, Eigen::Index components) const;

 private:
  gonio::valid_cells cells_;
  std::filesystem::path folder_;
  gonio::thread_count threads_;
  std::vector<gonio::material_set> sets_;
};

}  // namespace papers
