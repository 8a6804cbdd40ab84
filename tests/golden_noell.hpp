#pragma once
/// The small golden instance of Noell et al. 2014: eleven materials and the twelfth to reconstruct, over 1 of 1000
/// cells of MERL's grid. See /shared/reference/python/golden.py, part 5.

#include "golden.hpp"
#include "json.hpp"
#include <gonio/table/material_set.hpp>
#include <gonio/table/sample_set.hpp>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

struct golden_noell {
  gonio::material_set materials;  ///< the last one is measured
  std::vector<double> cosine_weights;
  nlohmann::json expected;

  [[nodiscard]] const std::string& truth_name() const { return materials.names.back(); }

  /// Every third row is measured; if asked for, every ninth of these has the value of another row.
  [[nodiscard]] gonio::sample_set samples(bool with_outliers) const {
    const auto truth = materials.table(materials.names.size() - 1);
    gonio::sample_set all;
    for (const auto row : expected["measured_rows"].get<std::vector<Eigen::Index>>())
      all.push_back({materials.cells.angles(row), truth.at(row)});
    const auto positions = expected["outlier_positions"].get<std::vector<Eigen::Index>>();
    const auto sources = expected["outlier_source_rows"].get<std::vector<Eigen::Index>>();
    if (with_outliers)
      for (std::size_t i = 0; i < positions.size(); ++i) all[positions[i]].value = truth.at(sources[i]);
    return all;
  }

  /// Root mean square over all cells of the log-relative difference from the truth, as the reference computes it.
  [[nodiscard]] double mapped_error(const gonio::brdf_table& estimate, std::size_t channel) const {
    double sum = 0.0;
    for (Eigen::Index cell = 0; cell < std::ssize(cosine_weights); ++cell) {
      const double truth = double{materials.values(cell, materials.values.cols() - 3 + channel)};
      const double found = double{estimate.values()[3 * cell + channel]}, weight = cosine_weights[cell];
      sum += std::pow(std::log((found * weight + 1e-3) / (truth * weight + 1e-3)), 2);
    }
    return std::sqrt(sum / static_cast<double>(cosine_weights.size()));
  }
};

/// The rows become cells of a grid of one row, all of which are valid: the method knows nothing of where a cell is.
inline const golden_noell& small_golden_noell() {
  static const golden_noell instance = [] {
    const auto columns = golden_csv("small_brdf.csv");
    const auto names = golden_json("small_ridge.json")["materials"].get<std::vector<std::string>>();
    const std::vector<double>& weights = columns.at("cosweight");
    const Eigen::Index rows = std::ssize(weights);
    golden_noell read{{gonio::valid_cells(gonio::grid({1, 1, static_cast<int>(rows)})), names,
                       gonio::cell_matrix(rows, 3 * names.size())},
                      weights,
                      golden_json("small_noell.json")};
    REQUIRE(read.materials.cells.size() == weights.size());
    for (std::size_t m = 0; m < names.size(); ++m)
      for (std::size_t c = 0; c < 3; ++c) {
        const std::vector<double>& column = columns.at(names[m] + "_" + "RGB"[c]);
        for (Eigen::Index row = 0; row < rows; ++row)
          read.materials.values(row, 3 * m + c) = static_cast<float>(column[row]);
      }
    return read;
  }();
  return instance;
}
