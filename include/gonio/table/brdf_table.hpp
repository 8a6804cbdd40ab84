#pragma once
/// A dense RGB table of a BRDF over the valid cells of a grid.

#include <gonio/core/brdf.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/core/uninitialised.hpp>
#include <gonio/table/location.hpp>

#include <Eigen/Core>

#include <span>
#include <utility>
#include <vector>

namespace gonio {

/// A BRDF in sr^-1 tabulated over valid cells, cell-major: red, green and blue of a cell are adjacent. Values are as
/// measured, may be negative and are not clamped.
class brdf_table {
 public:
  /// Makes a table of zeros.
  explicit brdf_table(valid_cells cells) : cells_(std::move(cells)), values_(3 * cells_.size(), 0.0f) {}

  /// Copies values of shape (cells, 3). Throws gonio::error unless there are 3 values per cell.
  brdf_table(valid_cells cells, const std::vector<float>& values);

  /// Returns a table of uninitialised values, for callers that set all of them.
  [[nodiscard]] static brdf_table uninitialised(valid_cells cells) {
    return brdf_table(std::move(cells), without_values());
  }

  [[nodiscard]] const valid_cells& cells() const noexcept { return cells_; }
  [[nodiscard]] std::span<const float> values() const noexcept { return values_; }
  [[nodiscard]] std::span<float> values() noexcept { return values_; }

  [[nodiscard]] rgb at(Eigen::Index cell) const noexcept {
    const float* value = values_.data() + 3 * cell;
    return {value[0], value[1], value[2]};
  }

  void set(Eigen::Index cell, const rgb& value) noexcept {
    for (Eigen::Index channel = 0; channel < 3; ++channel)
      values_[3 * cell + channel] = static_cast<float>(value[channel]);
  }

  /// Interpolates the stored values trilinearly; zero below the horizon.
  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept {
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return {0.0, 0.0, 0.0};
    return at(locate(cells_, to_half_difference(wi, wo)));
  }

  /// Interpolates the stored values trilinearly at a location on this table's cells.
  [[nodiscard]] rgb at(const location& at) const noexcept {
    rgb sum(0.0, 0.0, 0.0);
    for (int corner = 0; corner < at.count; ++corner) {
      const float* value = values_.data() + 3 * Eigen::Index{at.cell[corner]};
      for (Eigen::Index channel = 0; channel < 3; ++channel) sum[channel] += at.weight[corner] * double{value[channel]};
    }
    return sum;
  }

 private:
  struct without_values {};

  brdf_table(valid_cells cells, without_values /*unused*/) : cells_(std::move(cells)), values_(3 * cells_.size()) {}

  valid_cells cells_;
  std::vector<float, uninitialised_allocator<float>> values_;
};

static_assert(brdf<brdf_table>);

/// Reads a table at the nearest cell, as renderers read MERL files; zero below the horizon. A view: the table must
/// outlive it.
class nearest_lookup {
 public:
  explicit nearest_lookup(const brdf_table& table) noexcept : table_(&table) {}

  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept {
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return {0.0, 0.0, 0.0};
    const valid_cells& cells = table_->cells();
    const Eigen::Index linear = cells.grid().linear(cells.grid().nearest(to_half_difference(wi, wo)));
    return cells.contains(linear) ? table_->at(cells.representative(linear)) : rgb(0.0, 0.0, 0.0);
  }

 private:
  const brdf_table* table_;
};

static_assert(brdf<nearest_lookup>);

/// Evaluates a BRDF at every valid cell. Any number of threads gives the same bytes. Throws gonio::error if
/// `f.is_anisotropic()`.
template <brdf Brdf>
[[nodiscard]] brdf_table tabulate(const Brdf& f, const valid_cells& cells, thread_count threads = {}) {
  if constexpr (requires { f.is_anisotropic(); })
    if (f.is_anisotropic())
      refuse("the BRDF is anisotropic, but a table over half and difference angles needs an isotropic one");
  brdf_table table = brdf_table::uninitialised(cells);
  for_each_index(
      cells.size(), 4096,
      [&](Eigen::Index cell) {
        const auto [wi, wo] = to_directions(cells.angles(cell));
        table.set(cell, f(wi, wo));
      },
      threads);
  return table;
}

/// Reads a table at the cells of another grid by trilinear interpolation.
[[nodiscard]] brdf_table resample(const brdf_table& table, const valid_cells& cells, thread_count threads = {});

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/table/impl/brdf_table.ipp>
#endif
