#pragma once
/// A tabulated BRDF for the inner loop of a renderer. Look-up is nearest or trilinear, for one pair of directions or
/// many, in float or double. Values are stored as float, double or half. The grid is from Matusik et al., "A
/// Data-Driven Reflectance Model", SIGGRAPH 2003 (doi:10.1145/882262.882343).

#include <gonio/core/assertion.hpp>
#include <gonio/core/brdf.hpp>
#include <gonio/core/huge_pages.hpp>
#include <gonio/render/cell_finder.hpp>
#include <gonio/render/grid_coordinates.hpp>
#include <gonio/render/horizon_index.hpp>
#include <gonio/render/padded_grid.hpp>
#include <gonio/table/table_convention.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace gonio::render {

/// How values are looked up: at the nearest cell, or interpolated between the eight cells around a location.
enum class interpolation { nearest, trilinear };

/// The source of a `lookup_table`: values at the cells of a grid, such as a `brdf_table`.
template <class Table>
concept table_over_cells = requires(const Table& table, Eigen::Index linear) {
  { table.cells().grid() } -> std::convertible_to<grid>;
  { table.cells().representative(linear) } -> std::convertible_to<Eigen::Index>;
  { table.values()[linear] } -> std::convertible_to<double>;
};

/// A type that a table can store. `Eigen::half` has eleven bits, about three digits.
template <class Stored>
concept stored_number =
    std::same_as<Stored, float> || std::same_as<Stored, double> || std::same_as<Stored, Eigen::half>;

/// A table of values in sr^-1, at least zero. Half numbers are divided by a power of two that keeps them in range.
/// Cells below the horizon repeat cells above it. After construction, the table does not allocate, lock or throw; any
/// number of threads may read it.
///
/// Look-up is black if a direction is at or below the horizon, if a component is NaN, or if the magnitudes of all
/// components sum to more than 1e7. Directions need not be of unit length, but must have the same length.
/// ```cpp
/// const auto paint = gonio::render::lookup_table<Eigen::half>::of(table);  // a brdf_table
/// const auto f = paint(wi, wo);  // sr^-1, without the cosine, in float or double like the directions
/// ```
template <stored_number Stored = float, interpolation Interpolation = interpolation::trilinear>
class lookup_table {
 public:
  /// Converts a `brdf_table` or a similar type. Throws gonio::error if a value is not finite.
  template <table_over_cells Table>
  [[nodiscard]] static lookup_table of(const Table& table) {
    const auto& values = table.values();
    return lookup_table(table.cells().grid(), [&](const cell_index& cell) {
      const Eigen::Index at = 3 * table.cells().representative(table.cells().grid().linear(cell));
      return std::array<double, 3>{values[at], values[at + 1], values[at + 2]};
    });
  }

  /// Converts the data of a MERL file after its header: three planes in the file's scale. The position of the values
  /// within their cells is inferred from the cells without a value (`infer_convention`), as in `read_merl`. Negative
  /// values, which mark these cells in a file, become black. Throws gonio::error if the planes do not have the grid's
  /// size, or if a value is not finite.
  [[nodiscard]] static lookup_table from_merl(std::span<const double> planes, const grid_extents& extents = {}) {
    return from_merl(planes, gonio::grid(extents, infer_convention(planes, extents).anchor));
  }

  /// Converts the data of a MERL file like the other overload, for a grid with a known anchor.
  [[nodiscard]] static lookup_table from_merl(std::span<const double> planes, const gonio::grid& cells) {
    const Eigen::Index plane = cells.size();
    if (std::ssize(planes) != 3 * plane)
      refuse("a MERL table needs three planes of " + std::to_string(plane) + " values, not " +
             std::to_string(planes.size()) + " values");
    return lookup_table(cells, [&](const cell_index& cell) {
      const Eigen::Index at = cells.linear(cell);
      return std::array<double, 3>{planes[at] * merl_scale[0], planes[plane + at] * merl_scale[1],
                                   planes[2 * plane + at] * merl_scale[2]};
    });
  }

  /// Evaluates any BRDF at the nodes of a grid.
  template <brdf Brdf>
  [[nodiscard]] static lookup_table tabulated(const Brdf& f, const gonio::grid& cells = gonio::grid()) {
    return lookup_table(cells, [&](const cell_index& cell) {
      const auto [wi, wo] = to_directions(cells.angles(cell));
      const rgb value = f(wi, wo);
      return std::array<double, 3>{value.x(), value.y(), value.z()};
    });
  }

  /// Returns reflectance in sr^-1 for a pair in `float` or `double`.
  template <std::floating_point Real>
  [[nodiscard]] Eigen::Array<Real, 3, 1> operator()(const Eigen::Matrix<Real, 3, 1>& wi,
                                                    const Eigen::Matrix<Real, 3, 1>& wo) const noexcept {
    const Real ix = wi[0], iy = wi[1], iz = wi[2], ox = wo[0], oy = wo[1], oz = wo[2];
    if (!is_above_horizon(ix, iy, iz, ox, oy, oz)) return Eigen::Array<Real, 3, 1>::Zero();
    if constexpr (Interpolation == interpolation::nearest) {
      const auto cell = finder_.find(ix, iy, iz, ox, oy, oz);
      return value_at<Real>(cells_(cell.theta_h, cell.theta_d, cell.phi_d));
    } else {
      return value_at<Real>(locate(to_grid_coordinates(ix, iy, iz, ox, oy, oz)));
    }
  }

  /// Evaluates many pairs, with directions and results in arrays of equal length. It vectorises if the processor allows
  /// (compile with -O3 and for your processor). Results agree with single look-ups up to rounding. Precondition: the
  /// lengths are equal.
  template <std::floating_point Real>
  void evaluate(const component_arrays<const Real>& wi, const component_arrays<const Real>& wo,
                const component_arrays<Real>& out) const noexcept {
    GONIO_ASSERT(wi.size() == out.size() && wo.size() == out.size());
    using block_type = grid_coordinates_block<Real>;
    constexpr Eigen::Index size = block_type::size;
    const auto scale = static_cast<computed>(scale_);
    block_type block;
    std::array<location_of<Real>, size> locations;
    std::array<computed, size> factors;
    alignas(64) std::array<storage, size * read_per_location> stored;
    alignas(64) std::array<computed, size * read_per_location> wide;
    for (Eigen::Index first = 0; first < out.size(); first += size) {
      const Eigen::Index count = std::min(size, out.size() - first);
      block.compute(wi, wo, first, count);
      // Do each step for all pairs: while the processor waits for one value, it requests the next.
      for (Eigen::Index i = 0; i < size; ++i) locations[i] = locate(block[i]);
      for (Eigen::Index i = 0; i < size; ++i) read(locations[i], stored.data() + i * read_per_location);
      const computed* values = widened(stored, wide);
      for (Eigen::Index i = 0; i < count; ++i) {
        const Eigen::Index n = first + i;
        factors[i] = is_above_horizon(wi.x[n], wi.y[n], wi.z[n], wo.x[n], wo.y[n], wo.z[n]) ? scale : computed(0);
      }
      for (Eigen::Index i = 0; i < count; ++i) {
        const Eigen::Index n = first + i;
        const Eigen::Array<Real, 3, 1> colour = blended<Real>(locations[i], values + i * read_per_location, factors[i]);
        out.x[n] = colour.x();
        out.y[n] = colour.y();
        out.z[n] = colour.z();
      }
    }
  }

  [[nodiscard]] const gonio::grid& grid() const noexcept { return cells_.grid(); }

  /// Returns the memory of the values in bytes.
  [[nodiscard]] Eigen::Index memory() const noexcept { return values_.size() * sizeof(storage); }

 private:
  static constexpr bool is_half = std::is_same_v<Stored, Eigen::half>;
  using computed =
      std::conditional_t<std::is_same_v<Stored, double>, double, float>;  ///< type in which values are blended
  using storage = std::conditional_t<is_half, std::uint16_t, Stored>;     ///< bits of half numbers, as compilers do not
                                                                          ///< treat Eigen's class as a number

  /// `value_of(cell_index)` returns red, green and blue.
  template <class ValueOf>
  lookup_table(const gonio::grid& cells, const ValueOf& value_of) : cells_(cells), finder_(cells) {
    const auto [heights, rows, columns] = cells.extents();
    const horizon_index index(cells);
    std::vector<double> values(3 * index.size());
    std::vector<bool> is_known(index.size(), false);
    for (int h = 0; h < heights; ++h)
      for (int d = 0; d < rows; ++d)
        for (int p = 0; p < columns; ++p) {
          const Eigen::Index number = index(h, d, p);
          if (is_known[number]) continue;  // a cell below the horizon
          is_known[number] = true;
          const std::array<double, 3> value = value_of(cell_index{h, d, p});
          for (Eigen::Index channel = 0; channel < 3; ++channel) {
            if (!std::isfinite(static_cast<float>(value[channel])))
              refuse("a table for rendering is not finite in cell (" + std::to_string(h) + ", " + std::to_string(d) +
                     ", " + std::to_string(p) + ") of (theta_h, theta_d, phi_d)");
            values[3 * number + channel] = std::max(value[channel], 0.0);
          }
        }
    store(index, values);
  }

  /// Stores the values of the cells above the horizon, extended to all cells.
  void store(const horizon_index& index, const std::vector<double>& values) {
    const auto [heights, rows, columns] = grid().extents();
    scale_ = scale_of(values);
    values_.reserve(3 * cells_.size() + read_beyond);
    for (int h = 0; h < heights; ++h)
      for (int d = 0; d < rows; ++d)
        for (int p = -1; p <= columns; ++p) {
          const Eigen::Index number = index(h, d, p < 0 ? columns - 1 : p < columns ? p : 0);
          for (Eigen::Index channel = 0; channel < 3; ++channel)
            values_.push_back(std::bit_cast<storage>(static_cast<Stored>(values[3 * number + channel] / scale_)));
        }
    values_.resize(values_.size() + read_beyond, storage(0));
  }

  /// The location that is read for a pair of directions: one cell, or the first of eight cells with fractions.
  template <std::floating_point Real>
  using location_of = std::conditional_t<Interpolation == interpolation::nearest, std::int32_t, cell_corner<Real>>;

  template <std::floating_point Real>
  [[nodiscard]] location_of<Real> locate(const grid_coordinates<Real>& coordinates) const noexcept {
    if constexpr (Interpolation == interpolation::nearest)
      return cells_.nearest(coordinates);
    else
      return cells_.around(coordinates);
  }

  /// The number of values that are read for a location, padded to whole vectors: the three channels of the nearest cell
  /// or, for trilinear look-up, four rows with the three channels of both neighbours along phi_d.
  static constexpr Eigen::Index read_per_location = Interpolation == interpolation::nearest ? 4 : 4 * 8;

  void read(std::int32_t nearest, storage* out) const noexcept {
    std::memcpy(out, values_.data() + 3 * Eigen::Index{nearest}, 4 * sizeof(storage));
  }

  template <std::floating_point Real>
  void read(const cell_corner<Real>& around, storage* out) const noexcept {
    const storage* low = values_.data() + 3 * Eigen::Index{around.number};
    const storage* high = low + 3 * cells_.step_h();
    const Eigen::Index step = 3 * cells_.step_d();
    for (const storage* row : {low, low + step, high, high + step}) {
      std::memcpy(out, row, 8 * sizeof(storage));
      out += 8;
    }
  }

  /// Blends the values that were read for a location, and multiplies the result by `factor`.
  template <std::floating_point Real>
  [[nodiscard]] static Eigen::Array<Real, 3, 1> blended(const location_of<Real>& where, const computed* values,
                                                        computed factor) noexcept {
    if constexpr (Interpolation == interpolation::nearest) {
      return {static_cast<Real>(values[0] * factor), static_cast<Real>(values[1] * factor),
              static_cast<Real>(values[2] * factor)};
    } else {
      const Eigen::Map<const Eigen::Array<computed, 8, 4>> rows(values);
      const auto h = static_cast<computed>(where.theta_h) * factor, d = static_cast<computed>(where.theta_d),
                 p = static_cast<computed>(where.phi_d), rest_h = factor - h, rest_d = 1 - d;
      const Eigen::Array<computed, 8, 1> both = rows.col(0) * (rest_h * rest_d) + rows.col(1) * (rest_h * d) +
                                                rows.col(2) * (h * rest_d) + rows.col(3) * (h * d);
      return (both.template head<3>() * (1 - p) + both.template segment<3>(3) * p).template cast<Real>();
    }
  }

  template <std::floating_point Real>
  [[nodiscard]] Eigen::Array<Real, 3, 1> value_at(const location_of<Real>& where) const noexcept {
    std::array<storage, read_per_location> stored;
    std::array<computed, read_per_location> wide;
    read(where, stored.data());
    return blended<Real>(where, widened(stored, wide), static_cast<computed>(scale_));
  }

  /// Returns the stored values as numbers to compute with, in place. Half numbers, which are at least zero, are
  /// converted into `wide` by a shift of their bits and a multiplication by 2^112.
  template <std::size_t Size>
  [[nodiscard]] static const computed* widened(const std::array<storage, Size>& stored,
                                               std::array<computed, Size>& wide) noexcept {
    if constexpr (!is_half) {
      return stored.data();
    } else {
      for (std::size_t k = 0; k < Size; ++k)
        wide[k] = std::bit_cast<float>(static_cast<std::uint32_t>(stored[k]) << 13) * 0x1p112f;
      return wide.data();
    }
  }

  /// Returns the factor by which values are divided: 1, or for half numbers the power of two that brings the largest
  /// value near the end of their range, 65504.
  [[nodiscard]] static double scale_of(const std::vector<double>& values) {
    const double largest = *std::ranges::max_element(values);
    if (!is_half || !(largest > 0.0)) return 1.0;
    return std::exp2(std::ceil(std::log2(largest)) - 15.0);
  }

  static constexpr Eigen::Index read_beyond = 2;  ///< padding after the last cell

  padded_grid cells_;
  cell_finder<double> finder_;
  std::vector<storage, huge_page_allocator<storage>> values_;
  double scale_ = 1.0;
};

static_assert(brdf<lookup_table<>>);

}  // namespace gonio::render
