#pragma once
/// A BRDF with a value in every cell: the result of estimators without a basis.

#include <gonio/estimate/estimator.hpp>

#include <algorithm>
#include <utility>

namespace gonio {

/// A table of values that are at least zero. Evaluation interpolates it trilinearly.
class completed_table {
 public:
  /// Takes a table. Replaces negative values by zero.
  explicit completed_table(brdf_table table) : table_(std::move(table)) {
    for (float& value : table_.values()) value = std::max(value, 0.0f);
  }

  [[nodiscard]] const brdf_table& table() const noexcept { return table_; }

  /// Returns the reflectance in sr^-1, at least zero; zero below the horizon.
  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept { return table_(wi, wo); }

  /// Returns the table itself, or interpolates it at the cells of another grid. Any number of threads gives the same
  /// bytes.
  [[nodiscard]] brdf_table tabulate(const valid_cells& cells, thread_count threads = {}) const {
    return resample(table_, cells, threads);
  }

 private:
  brdf_table table_;
};

static_assert(tabulated_brdf<completed_table>);

}  // namespace gonio
