#pragma once
/// Tables of several materials over the same cells, as one matrix.

#include <gonio/table/brdf_table.hpp>
#include <gonio/table/cell_matrix.hpp>
#include <gonio/table/domain.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <iterator>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace gonio {

/// Dense tables of named materials over common cells; `values` has shape (cells, 3 materials), sr^-1.
/// 100 materials on MERL's grid take 1.3 GB.
struct material_set {
  valid_cells cells;
  std::vector<std::string> names;
  cell_matrix values;

  /// Returns the position of a material. Throws gonio::error if none has that name.
  [[nodiscard]] Eigen::Index find(const std::string& name) const;

  /// Returns a copy of one material's table.
  [[nodiscard]] brdf_table table(Eigen::Index material) const;

  /// Returns a copy of some of the materials, by their positions. Throws gonio::error for an invalid position.
  [[nodiscard]] material_set subset(const std::vector<Eigen::Index>& positions) const;
};

/// Returns a material's family: the part of its name before the first underscore, which identifies the maker.
[[nodiscard]] inline std::string material_family(const std::string& name) { return name.substr(0, name.find('_')); }

/// Data from which a basis is learned: named items, such as materials or shapes, over a common domain, `cells`.
/// `values` has a row for each location and a column for each channel of each item.
template <class Set>
concept observation_set = requires(Set& things) {
  requires domain<std::remove_cvref_t<decltype(things.cells)>>;
  requires std::same_as<std::remove_cvref_t<decltype(things.names)>, std::vector<std::string>>;
  requires std::same_as<std::remove_cvref_t<decltype(things.values)>, cell_matrix>;
};

static_assert(observation_set<material_set>);

/// The domain of a set.
template <observation_set Set>
using domain_of_set = std::remove_cvref_t<decltype(std::declval<Set&>().cells)>;

/// Throws gonio::error unless there is at least one item, with all of its columns and a row for each location.
template <observation_set Set>
void require_complete(const Set& things) {
  constexpr Eigen::Index channels = channels_over<domain_of_set<Set>>;
  if (things.names.empty() || things.values.cols() != channels * std::ssize(things.names) ||
      things.values.rows() != things.cells.size())
    refuse(
        {"a basis needs at least one material, each with ", channels, " columns over ", things.cells.size(), " cells"});
}

/// Throws gonio::error naming the first material that is not finite at a cell. (Observations other than materials are
/// checked before, with messages of their own.)
template <observation_set Set>
void require_finite(const Set& things, Eigen::Index cell) {
  const auto row = things.values.row(cell);
  if (row.allFinite()) return;
  Eigen::Index column = 0;
  while (std::isfinite(row[column])) ++column;
  const Eigen::Index thing = column / channels_over<domain_of_set<Set>>;
  refuse({"material '", things.names[thing], "' is not finite at cell ", cell});
}

/// Applies `map` to each value at a cell. Throws gonio::error naming the first item that is not finite there, before
/// the map (which may hide an infinity) or after it (which may overflow).
template <observation_set Set, class Map>
void map_cell(Set& things, Eigen::Index cell, Map&& map) {
  require_finite(things, cell);
  auto row = things.values.row(cell);
  row = row.unaryExpr([&](float value) { return static_cast<float>(map(value)); });
  require_finite(things, cell);
}

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/table/impl/material_set.ipp>
#endif
