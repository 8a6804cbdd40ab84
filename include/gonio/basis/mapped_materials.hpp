#pragma once
/// Materials that are read a block of cells at a time, mapped relative to their median and centred: X - mu of Nielsen
/// et al. 2015 (doi:10.1145/2816795.2818085), Eq. 2-4, without storing X.

#include <gonio/metric/log_relative.hpp>
#include <gonio/solve/row_source.hpp>
#include <gonio/table/material_rows.hpp>

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gonio {

namespace detail {

/// Throws gonio::error naming the first material that is not finite in a row, which has all values at a cell.
void require_finite(const cell_matrix& rows, Eigen::Index row, Eigen::Index cell, const material_rows& materials);

}  // namespace detail

/// Rows of X - mu: a row for each cell, a column for each channel of each material. The first pass over the cells finds
/// each cell's reference (the median of its columns) and mean; later passes use them. If several processes share the
/// cells, the process that uses all results must receive those of the other processes. A value type; copies share the
/// results: 12 bytes a cell.
class mapped_materials {
 public:
  /// Throws gonio::error if there is no material.
  explicit mapped_materials(material_rows materials, cosine_weighting weighting = cosine_weighting::product);
  /// Maps relative to a known reference. Throws gonio::error unless it is over the materials' cells.
  mapped_materials(material_rows materials, const log_relative& metric);

  /// Returns rows whose reading also computes reference, mean and variation of their cells. Reading throws gonio::error
  /// naming the first material that is not finite at a cell.
  [[nodiscard]] row_source first_pass() const { return source(true); }
  /// Returns the rows of `first_pass`, for cells that the first pass has read.
  [[nodiscard]] row_source rows() const { return source(false); }

  [[nodiscard]] const material_rows& materials() const noexcept;
  /// Return the results of the first pass for each cell, 0 for unread ones: the reference (unless known before), mu,
  /// and the squared norm of the row of X - mu.
  [[nodiscard]] std::span<float> reference() const noexcept;
  [[nodiscard]] std::span<float> mean() const noexcept;
  [[nodiscard]] std::span<float> variation() const noexcept;

  /// Returns the squared norm of X - mu, summed over all rows in order.
  [[nodiscard]] double total_variation() const noexcept;

  /// Returns the metric, after all cells were read. Throws gonio::error if the reference is negative or not finite.
  [[nodiscard]] log_relative metric() const;

 private:
  struct state;
  [[nodiscard]] row_source source(bool first) const;

  std::shared_ptr<state> state_;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/basis/impl/mapped_materials.ipp>
#endif
