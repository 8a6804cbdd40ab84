#pragma once
/// The change of a surface's colour that makes it look different by a given amount.

#include <gonio/evaluate/appearance_metric.hpp>

#include <algorithm>

namespace papers {

/// Returns the factors 1 + t `towards` of the channels that make a table look `wanted` Delta E different under the
/// environment. Six secants through the origin find t.
[[nodiscard]] inline gonio::rgb factor_of(const gonio::appearance_metric& judge, const gonio::brdf_table& table,
                                          const gonio::rgb& towards, double wanted, gonio::thread_count threads) {
  const gonio::appearance seen = judge.look(table, threads);
  double step = 0.02 * wanted;
  for (int round = 0; round < 6; ++round) {
    gonio::brdf_table shifted = table;
    for (Eigen::Index cell = 0; cell < table.cells().size(); ++cell)
      shifted.set(cell, table.at(cell) * (1.0 + step * towards));
    const double found = gonio::appearance_metric::difference(judge.look(shifted, threads), seen).environment;
    step *= std::clamp(wanted / std::max(found, 1e-6), 0.2, 5.0);
  }
  return 1.0 + step * towards;
}

}  // namespace papers
