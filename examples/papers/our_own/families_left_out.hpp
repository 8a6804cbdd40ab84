#pragma once
/// Materials to learn from and to judge, told apart by their families: a prior for a measured material is learned
/// without all of its maker's.

#include "command_line/thinning.hpp"
#include "papers/experiments.hpp"
#include <gonio/core/progress.hpp>
#include <gonio/io/networks.hpp>
#include <gonio/io/rgl.hpp>
#include <gonio/table/material_set.hpp>
#include <gonio/table/sample_set.hpp>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

namespace papers {

/// Materials of one maker: names before the first underscore are alike.
inline std::string family_of(const std::string& name) { return name.substr(0, name.find('_')); }

/// Values of a function of a direction_pair in some directions, each channel with noise relative to it.
template <class Reflectance>
[[nodiscard]] gonio::sample_set measure(const Reflectance& reflectance,
                                        const std::vector<gonio::half_difference>& directions, double noise,
                                        std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  gonio::sample_set samples;
  for (const gonio::half_difference& angles : directions) {
    gonio::rgb value = reflectance(gonio::to_directions(angles));
    for (Eigen::Index c = 0; c < 3; ++c) value[c] *= 1.0 + noise * normal(random);
    samples.push_back({angles, value, 1.0});
  }
  return samples;
}

/// Materials that are judged, or learned from, as tables.
class material_library {
 public:
  /// Tabulates some files of networks, and then a folder of measured materials, over thinned cells. Throws gonio::error
  /// if the folder has none.
  material_library(const std::vector<std::filesystem::path>& networks, const std::filesystem::path& materials,
                   const thinning& thin, gonio::thread_count threads, const gonio::progress& listener)
      : cells_(thin.of(gonio::valid_cells())), threads_(threads) {
    for (const std::filesystem::path& file : networks)
      sets_.push_back(gonio::model::tabulate_networks(gonio::io::read_networks(file), cells_, threads, listener));
    gonio::material_set measured{cells_, {}, {}};
    const auto files = gonio::io::list_rgl_directory(materials);
    if (files.empty()) gonio::refuse(materials.string() + ": holds no material (*.bsdf)");
    measured.values.resize(static_cast<Eigen::Index>(cells_.size()), 3 * std::ssize(files));
    for (const auto& [name, path] : files) {
      const gonio::brdf_table table = gonio::tabulate(gonio::io::read_rgl(path).material, cells_, threads);
      measured.values.middleCols(3 * std::ssize(measured.names), 3) =
          Eigen::Map<const gonio::cell_matrix>(table.values().data(), measured.values.rows(), 3);
      measured.names.push_back(name);
    }
    sets_.push_back(std::move(measured));
  }

  [[nodiscard]] const gonio::valid_cells& cells() const noexcept { return cells_; }
  [[nodiscard]] const gonio::material_set& measured() const noexcept { return sets_.back(); }
  [[nodiscard]] const gonio::material_set& first() const noexcept { return sets_.front(); }

  /// Of the first `sets` files of networks, or of everything, the materials that `keep` does not refuse.
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
  [[nodiscard]] Eigen::Index all() const noexcept { return sets_.size(); }

 private:
  gonio::valid_cells cells_;
  gonio::thread_count threads_;
  std::vector<gonio::material_set> sets_;
};

}  // namespace papers
